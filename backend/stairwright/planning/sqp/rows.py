"""Constraints of one pose as rows "value >= 0": value, gradient and curvature.

A distance between convex shapes is the best separating axis (a hard maximum); each corner that
supports the shape on that axis is a row of its own, so that rows are smooth. Derivatives are by
u = (x, z, five absolute angles, s_front, s_rear); `state.State` says how points depend on them.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from .cells import Course
from .state import ANGLES, HIP, KNEE, POINTS, WHEEL, Body, State, com

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

JOINT, PLACE, BEHIND, PLANE, ACROSS, APART, COM = 0, 1, 2, 3, 4, 5, 6
U = ANGLES + 4  # length of u
MOST = 1000  # rows kept; what lies beyond is still measured
LOOK = 0.15  # m; rows with more slack do not guide a step
_CENTRE = -1  # in place of a point's index: the trunk's centre
_FIXED = -1  # in place of a point's index: the fixed point in the row's numbers


class Task(NamedTuple):
    """What is asked of a pose. SI units.

    Attributes:
        reference, weights: (7,) of eq 17: x, z, pitch, joints.
        lower, upper: (9,) bounds of [x, z, pitch, q1..4, s_front, s_rear]; x, z, pitch are free.
        clearance: Least distance of trunk and links (or points) from the ground.
        apart: Least distance of the front leg from the rear one.
        hip: Least distance of the rear contact behind the rear hip (eq 20), or -inf.
        links: Keep whole links clear instead of the collision points (eq 21).
        com_low, com_high: Where the centre of mass must be along x; infinite where it is free.
    """

    reference: Floats
    weights: Floats
    lower: Floats
    upper: Floats
    clearance: float
    apart: float
    hip: float
    links: bool
    com_low: float
    com_high: float


class Rows(NamedTuple):
    """Rows of the constraints.

    Attributes:
        what: (m, 4) kind, point i, point j, index of angle or normal.
        numbers: (m, 4) normal or fixed point (x, z), sign, offset.
        value: (m,) slack, >= 0 where the constraint holds [m or rad].
    """

    what: Ints
    numbers: Floats
    value: Floats


@nb.njit(cache=True)
def new_rows() -> Rows:
    """Room for `MOST` rows."""
    return Rows(np.empty((MOST, 4), np.int64), np.empty((MOST, 4)), np.empty(MOST))


@nb.njit(cache=True)
def _add(
    rows: Rows, count: int, kind: int, i: int, j: int, turn: int,
    nx: float, nz: float, sign: float, offset: float, value: float,
) -> int:  # fmt: skip
    if value > LOOK or count >= MOST:
        return count
    rows.what[count, 0], rows.what[count, 1] = kind, i
    rows.what[count, 2], rows.what[count, 3] = j, turn
    rows.numbers[count, 0], rows.numbers[count, 1] = nx, nz
    rows.numbers[count, 2], rows.numbers[count, 3] = sign, offset
    rows.value[count] = value
    return count + 1


@nb.njit(cache=True)
def collect(body: Body, course: Course, task: Task, st: State, rows: Rows) -> tuple[int, float]:
    """Fill `rows` with what is near its bound; returns their number and the least slack of all."""
    count, least = 0, np.inf
    for k in range(4):
        i = 1 + k  # absolute angle of the joint's link, and of the link that it turns against
        j = 0 if k == 0 or k == 2 else k
        for side in range(2):
            sign = 1.0 if side == 0 else -1.0
            bound = task.lower[3 + k] if side == 0 else task.upper[3 + k]
            value = sign * (st.q[k] - bound)
            least = min(least, value)
            count = _add(rows, count, JOINT, i, j, -1, 0.0, 0.0, sign, sign * bound, value)
    for k in range(2):
        if task.upper[7 + k] <= task.lower[7 + k]:
            continue  # fixed: not among the unknowns
        for side in range(2):
            sign = 1.0 if side == 0 else -1.0
            bound = task.lower[7 + k] if side == 0 else task.upper[7 + k]
            value = sign * (st.y[3 + k] - bound)
            least = min(least, value)
            count = _add(rows, count, PLACE, k, -1, -1, 0.0, 0.0, sign, sign * bound, value)
    if task.hip > -np.inf:
        value = st.points[HIP + 1, 0] - st.contact[0] - task.hip
        least = min(least, value)
        count = _add(rows, count, BEHIND, HIP + 1, -1, -1, 1.0, 0.0, 1.0, task.hip, value)
    for side in range(2):
        sign, bound = (1.0, task.com_low) if side == 0 else (-1.0, task.com_high)
        if math.isfinite(bound):
            value = sign * (com(st, 0) - bound)
            least = min(least, value)
            count = _add(rows, count, COM, -1, -1, -1, 0.0, 0.0, sign, sign * bound, value)
    count, least = _ground(body, course, task, st, rows, count, least)
    return _legs(body, task, st, rows, count, least)


@nb.njit(cache=True)
def _ground(
    body: Body, course: Course, task: Task, st: State, rows: Rows, count: int, least: float
) -> tuple[int, float]:
    """Trunk and links, or the collision points, from every cell near them."""
    points, p = st.points, body.planar
    far = LOOK + task.clearance
    if not task.links:
        for i in range(POINTS, len(points)):
            count, least = _point(course, task, points, i, far, rows, count, least)
        return count, least
    for shape in range(5):
        if shape == 0:
            a, b, radius = 0, 0, 0.0
            x0 = min(min(points[0, 0], points[1, 0]), min(points[2, 0], points[3, 0]))
            x1 = max(max(points[0, 0], points[1, 0]), max(points[2, 0], points[3, 0]))
            low = min(min(points[0, 1], points[1, 1]), min(points[2, 1], points[3, 1]))
        else:
            leg, upper = (shape - 1) // 2, shape % 2 == 1
            a, b = (HIP + leg, KNEE + leg) if upper else (KNEE + leg, WHEEL + leg)
            radius = p.thigh_radius if upper else p.calf_radius
            x0 = min(points[a, 0], points[b, 0]) - radius
            x1 = max(points[a, 0], points[b, 0]) + radius
            low = min(points[a, 1], points[b, 1]) - radius
        for cell in range(len(course.boxes)):
            if course.boxes[cell, 0] > x1 + far:
                break
            if course.boxes[cell, 1] < x0 - far or course.boxes[cell, 2] < low - far:
                continue
            if shape == 0:
                count, least = _trunk(body, course, task, st, cell, rows, count, least)
            else:
                count, least = _link(
                    course, task, st, cell, a, b, 1 + shape, radius, rows, count, least
                )
    return count, least


@nb.njit(cache=True)
def _point(
    course: Course, task: Task, points: Floats, i: int, far: float,
    rows: Rows, count: int, least: float,
) -> tuple[int, float]:  # fmt: skip
    x, z = points[i, 0], points[i, 1]
    for cell in range(len(course.boxes)):
        if course.boxes[cell, 0] > x + far:
            break
        if course.boxes[cell, 1] < x - far or course.boxes[cell, 2] < z - far:
            continue
        best, face = -np.inf, 0
        for k in range(course.spans[cell, 0], course.spans[cell, 1]):
            gap = course.faces[k, 0] * x + course.faces[k, 1] * z - course.faces[k, 2]
            if gap > best:
                best, face = gap, k
        least = min(least, best - task.clearance)
        f = course.faces[face]
        count = _add(
            rows, count, PLANE, i, -1, -1, f[0], f[1], 1.0, f[2] + task.clearance,
            best - task.clearance,
        )  # fmt: skip
    return count, least


@nb.njit(cache=True)
def _trunk(
    body: Body, course: Course, task: Task, st: State, cell: int,
    rows: Rows, count: int, least: float,
) -> tuple[int, float]:  # fmt: skip
    """The trunk from one cell: faces of the cell, sides of the trunk."""
    points, normals = st.points, st.normals
    best, axis, sign = -np.inf, 0, 0.0
    for k in range(course.spans[cell, 0], course.spans[cell, 1]):
        f = course.faces[k]
        low = np.inf
        for i in range(4):
            low = min(low, f[0] * points[i, 0] + f[1] * points[i, 1])
        if low - f[2] > best:
            best, axis = low - f[2], k
    first, last = course.spans[cell, 2], course.spans[cell, 3]
    for k in range(2):
        half = body.planar.half_length if k == 0 else body.planar.half_height
        low, high = np.inf, -np.inf
        for i in range(first, last):
            h = normals[k, 0] * (course.points[i, 0] - st.y[0])
            h += normals[k, 1] * (course.points[i, 1] - st.y[1])
            low, high = min(low, h), max(high, h)
        if low - half > best:
            best, axis, sign = low - half, k, 1.0
        if -high - half > best:
            best, axis, sign = -high - half, k, -1.0
    least = min(least, best - task.clearance)
    if sign == 0.0:
        f = course.faces[axis]
        offset = f[2] + task.clearance
        for i in range(4):
            value = f[0] * points[i, 0] + f[1] * points[i, 1] - offset
            count = _add(rows, count, PLANE, i, -1, -1, f[0], f[1], 1.0, offset, value)
        return count, least
    offset = task.clearance
    offset += body.planar.half_length if axis == 0 else body.planar.half_height
    for i in range(first, last):
        x, z = course.points[i, 0], course.points[i, 1]
        value = normals[axis, 0] * (x - st.y[0]) + normals[axis, 1] * (z - st.y[1])
        value = sign * value - offset
        count = _add(rows, count, ACROSS, _FIXED, _CENTRE, axis, x, z, sign, offset, value)
    return count, least


@nb.njit(cache=True)
def _link(
    course: Course, task: Task, st: State, cell: int, a: int, b: int, normal: int, radius: float,
    rows: Rows, count: int, least: float,
) -> tuple[int, float]:  # fmt: skip
    """One link from one cell: faces of the cell, sides of the link."""
    points = st.points
    nx, nz = st.normals[normal, 0], st.normals[normal, 1]
    best, axis, sign = -np.inf, 0, 0.0
    for k in range(course.spans[cell, 0], course.spans[cell, 1]):
        f = course.faces[k]
        low = min(
            f[0] * points[a, 0] + f[1] * points[a, 1], f[0] * points[b, 0] + f[1] * points[b, 1]
        )
        if low - f[2] > best:
            best, axis = low - f[2], k
    first, last = course.spans[cell, 2], course.spans[cell, 3]
    low, high = np.inf, -np.inf
    for i in range(first, last):
        h = nx * (course.points[i, 0] - points[a, 0]) + nz * (course.points[i, 1] - points[a, 1])
        low, high = min(low, h), max(high, h)
    if low > best:
        best, sign = low, 1.0
    if -high > best:
        best, sign = -high, -1.0
    bound = radius + task.clearance
    least = min(least, best - bound)
    if sign == 0.0:
        f = course.faces[axis]
        for i in (a, b):
            value = f[0] * points[i, 0] + f[1] * points[i, 1] - f[2] - bound
            count = _add(rows, count, PLANE, i, -1, -1, f[0], f[1], 1.0, f[2] + bound, value)
        return count, least
    for i in range(first, last):
        x, z = course.points[i, 0], course.points[i, 1]
        value = sign * (nx * (x - points[a, 0]) + nz * (z - points[a, 1])) - bound
        count = _add(rows, count, ACROSS, _FIXED, a, normal, x, z, sign, bound, value)
    return count, least


@nb.njit(cache=True)
def _legs(
    body: Body, task: Task, st: State, rows: Rows, count: int, least: float
) -> tuple[int, float]:
    """Front leg from rear leg: wheels, wheels and knees from the other leg's links."""
    p, points = body.planar, st.points
    gap = math.hypot(
        points[WHEEL, 0] - points[WHEEL + 1, 0], points[WHEEL, 1] - points[WHEEL + 1, 1]
    )
    offset = 2 * p.wheel_radius + task.apart
    least = min(least, gap - offset)
    count = _add(
        rows, count, APART, WHEEL, WHEEL + 1, -1, 0.0, 0.0, 1.0, offset, gap - offset
    )  # fmt: skip
    for leg in range(2):
        other = 1 - leg
        for part in range(2):
            point = WHEEL + leg if part == 0 else KNEE + leg
            mine = p.wheel_radius if part == 0 else p.thigh_radius
            for link in range(2):
                a, b = (HIP, KNEE) if link == 0 else (KNEE, WHEEL)
                length = p.thigh if link == 0 else p.calf
                theirs = p.thigh_radius if link == 0 else p.calf_radius
                normal = 2 + 2 * other + link
                offset = mine + theirs + task.apart
                count, least = _segment(
                    st, point, a + other, b + other, normal, length, offset, rows, count, least
                )
    return count, least


@nb.njit(cache=True)
def _segment(
    st: State, point: int, a: int, b: int, normal: int, length: float, offset: float,
    rows: Rows, count: int, least: float,
) -> tuple[int, float]:  # fmt: skip
    """A point from a link that runs from point `a` to point `b`."""
    points = st.points
    nx, nz = st.normals[normal, 0], st.normals[normal, 1]
    dx, dz = points[point, 0] - points[a, 0], points[point, 1] - points[a, 1]
    along = (dx * (points[b, 0] - points[a, 0]) + dz * (points[b, 1] - points[a, 1])) / length
    if 0.0 <= along <= length:
        height = nx * dx + nz * dz
        sign = 1.0 if height >= 0.0 else -1.0
        value = sign * height - offset
        least = min(least, value)
        return _add(
            rows, count, ACROSS, point, a, normal, 0.0, 0.0, sign, offset, value
        ), least  # fmt: skip
    end = a if along < 0.0 else b
    value = math.hypot(points[point, 0] - points[end, 0], points[point, 1] - points[end, 1])
    value -= offset
    least = min(least, value)
    return _add(rows, count, APART, point, end, -1, 0.0, 0.0, 1.0, offset, value), least


@nb.njit(cache=True)
def gradient(st: State, rows: Rows, k: int, out: Floats) -> None:
    """Gradient (U,) of row `k` by u."""
    kind, i, j = rows.what[k, 0], rows.what[k, 1], rows.what[k, 2]
    nx, nz, sign = rows.numbers[k, 0], rows.numbers[k, 1], rows.numbers[k, 2]
    out[:] = 0.0
    if kind == JOINT:
        out[2 + i], out[2 + j] = sign, -sign
    elif kind == PLACE:
        out[7 + i] = sign
    elif kind in (BEHIND, PLANE):
        _pull(st, i, nx, nz, out)
        if kind == BEHIND:
            out[8] -= st.contact[1]
    elif kind == COM:
        out[0] += sign * st.shares[0]
        for k in range(6):
            _pull(st, HIP + k, sign * st.shares[1 + k // 2], 0.0, out)
    elif kind == ACROSS:
        turn = rows.what[k, 3]
        ax, az = sign * st.normals[turn, 0], sign * st.normals[turn, 1]
        dx, dz = _between(st, rows, k)
        angle = 0 if turn < 2 else turn - 1
        if i != _FIXED:
            _pull(st, i, ax, az, out)
        _pull(st, j, -ax, -az, out)
        out[2 + angle] += az * dx - ax * dz
    else:
        dx, dz = _between(st, rows, k)
        gap = max(math.hypot(dx, dz), 1e-9)
        _pull(st, i, dx / gap, dz / gap, out)
        _pull(st, j, -dx / gap, -dz / gap, out)


@nb.njit(cache=True)
def _pull(st: State, i: int, nx: float, nz: float, out: Floats) -> None:
    """Add the gradient of n . (point i)."""
    out[0] += nx
    out[1] += nz
    if i != _CENTRE:
        for a in range(ANGLES):
            out[2 + a] += nx * st.arms[i, a, 1] - nz * st.arms[i, a, 0]


@nb.njit(cache=True)
def _between(st: State, rows: Rows, k: int) -> tuple[float, float]:
    """From point j of a row to its point i."""
    i, j = rows.what[k, 1], rows.what[k, 2]
    ax = st.y[0] if j == _CENTRE else st.points[j, 0]
    az = st.y[1] if j == _CENTRE else st.points[j, 1]
    if rows.what[k, 0] == ACROSS and i == _FIXED:
        return rows.numbers[k, 0] - ax, rows.numbers[k, 1] - az
    return st.points[i, 0] - ax, st.points[i, 1] - az


@nb.njit(cache=True)
def add_curvature(st: State, rows: Rows, k: int, factor: float, H: Floats) -> None:
    """Add `factor` times the second derivative of row `k` to H (U, U)."""
    kind, i, j = rows.what[k, 0], rows.what[k, 1], rows.what[k, 2]
    nx, nz, sign = rows.numbers[k, 0], rows.numbers[k, 1], rows.numbers[k, 2]
    if kind in (BEHIND, PLANE):
        _bend(st, i, factor * nx, factor * nz, H)
    elif kind == COM:
        for k in range(6):
            _bend(st, HIP + k, factor * sign * st.shares[1 + k // 2], 0.0, H)
    elif kind == ACROSS:
        turn = rows.what[k, 3]
        ax = factor * sign * st.normals[turn, 0]
        az = factor * sign * st.normals[turn, 1]
        dx, dz = _between(st, rows, k)
        angle = 2 + (0 if turn < 2 else turn - 1)
        if i != _FIXED:
            _bend(st, i, ax, az, H)
        _bend(st, j, -ax, -az, H)
        H[angle, angle] -= ax * dx + az * dz
        tilt = np.zeros(U)
        if i != _FIXED:
            _pull(st, i, az, -ax, tilt)
        _pull(st, j, -az, ax, tilt)
        for a in range(U):
            H[angle, a] += tilt[a]
            H[a, angle] += tilt[a]
    elif kind == APART:
        dx, dz = _between(st, rows, k)
        gap = max(math.hypot(dx, dz), 1e-9)
        ux, uz = dx / gap, dz / gap
        _bend(st, i, factor * ux, factor * uz, H)
        _bend(st, j, -factor * ux, -factor * uz, H)
        across = np.zeros(U)  # |d|'' = (across the line)(across the line)' / |d|
        _pull(st, i, -uz, ux, across)
        _pull(st, j, uz, -ux, across)
        for a in range(U):
            for b in range(U):
                H[a, b] += factor * across[a] * across[b] / gap


@nb.njit(cache=True)
def _bend(st: State, i: int, nx: float, nz: float, H: Floats) -> None:
    """Add the second derivative of n . (point i)."""
    if i != _CENTRE:
        for a in range(ANGLES):
            H[2 + a, 2 + a] -= nx * st.arms[i, a, 0] + nz * st.arms[i, a, 1]
