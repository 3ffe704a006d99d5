"""Which constraints are near: joint limits, places, eq 20, balance, ground (eq 21), other leg.

A distance between convex shapes is the best separating axis (a hard maximum); each corner that
supports the shape on that axis is a row of its own, so that rows are smooth.
"""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf

from .cells import Course
from .rows import (
    ACROSS,
    APART,
    BEHIND,
    CENTRE,
    COM,
    FIXED,
    JOINT,
    LOOK,
    PLACE,
    PLANE,
    Rows,
    Task,
    add_row,
)
from .state import HIP, KNEE, POINTS, WHEEL, Body, State, com

Floats = NDArray[np.float64]


@leaf
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
            count = add_row(rows, count, JOINT, i, j, -1, 0.0, 0.0, sign, sign * bound, value)
    for k in range(2):
        if task.upper[7 + k] <= task.lower[7 + k]:
            continue  # fixed: not among the unknowns
        for side in range(2):
            sign = 1.0 if side == 0 else -1.0
            bound = task.lower[7 + k] if side == 0 else task.upper[7 + k]
            value = sign * (st.y[3 + k] - bound)
            least = min(least, value)
            count = add_row(rows, count, PLACE, k, -1, -1, 0.0, 0.0, sign, sign * bound, value)
    if task.hip > -np.inf:
        value = st.points[HIP + 1, 0] - st.contact[0] - task.hip
        least = min(least, value)
        count = add_row(rows, count, BEHIND, HIP + 1, -1, -1, 1.0, 0.0, 1.0, task.hip, value)
    for side in range(2):
        sign, bound = (1.0, task.com_low) if side == 0 else (-1.0, task.com_high)
        if math.isfinite(bound):
            value = sign * (com(st, 0) - bound)
            least = min(least, value)
            count = add_row(rows, count, COM, -1, -1, -1, 0.0, 0.0, sign, sign * bound, value)
    count, least = _ground(body, course, task, st, rows, count, least)
    return _legs(body, task, st, rows, count, least)


@leaf
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


@leaf
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
        nx, nz, offset = _face(course, face)
        count = add_row(
            rows, count, PLANE, i, -1, -1, nx, nz, 1.0, offset + task.clearance,
            best - task.clearance,
        )  # fmt: skip
    return count, least


@nb.njit(cache=True, inline="always")
def _trunk(
    body: Body, course: Course, task: Task, st: State, cell: int,
    rows: Rows, count: int, least: float,
) -> tuple[int, float]:  # fmt: skip
    """The trunk from one cell: faces of the cell, sides of the trunk."""
    points, normals = st.points, st.normals
    best, axis, sign = -np.inf, 0, 0.0
    for k in range(course.spans[cell, 0], course.spans[cell, 1]):
        nx, nz, offset = _face(course, k)
        low = np.inf
        for i in range(4):
            low = min(low, nx * points[i, 0] + nz * points[i, 1])
        if low - offset > best:
            best, axis = low - offset, k
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
        nx, nz, offset = _face(course, axis)
        offset += task.clearance
        for i in range(4):
            value = nx * points[i, 0] + nz * points[i, 1] - offset
            count = add_row(rows, count, PLANE, i, -1, -1, nx, nz, 1.0, offset, value)
        return count, least
    offset = task.clearance
    offset += body.planar.half_length if axis == 0 else body.planar.half_height
    for i in range(first, last):
        x, z = course.points[i, 0], course.points[i, 1]
        value = normals[axis, 0] * (x - st.y[0]) + normals[axis, 1] * (z - st.y[1])
        value = sign * value - offset
        count = add_row(rows, count, ACROSS, FIXED, CENTRE, axis, x, z, sign, offset, value)
    return count, least


@nb.njit(cache=True, inline="always")
def _link(
    course: Course, task: Task, st: State, cell: int, a: int, b: int, normal: int, radius: float,
    rows: Rows, count: int, least: float,
) -> tuple[int, float]:  # fmt: skip
    """One link from one cell: faces of the cell, sides of the link."""
    points = st.points
    nx, nz = st.normals[normal, 0], st.normals[normal, 1]
    best, axis, sign = -np.inf, 0, 0.0
    for k in range(course.spans[cell, 0], course.spans[cell, 1]):
        fx, fz, offset = _face(course, k)
        low = min(fx * points[a, 0] + fz * points[a, 1], fx * points[b, 0] + fz * points[b, 1])
        if low - offset > best:
            best, axis = low - offset, k
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
        fx, fz, offset = _face(course, axis)
        offset += bound
        for i in (a, b):
            value = fx * points[i, 0] + fz * points[i, 1] - offset
            count = add_row(rows, count, PLANE, i, -1, -1, fx, fz, 1.0, offset, value)
        return count, least
    for i in range(first, last):
        x, z = course.points[i, 0], course.points[i, 1]
        value = sign * (nx * (x - points[a, 0]) + nz * (z - points[a, 1])) - bound
        count = add_row(rows, count, ACROSS, FIXED, a, normal, x, z, sign, bound, value)
    return count, least


@leaf
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
    count = add_row(
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


@nb.njit(cache=True, inline="always")
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
        return add_row(
            rows, count, ACROSS, point, a, normal, 0.0, 0.0, sign, offset, value
        ), least  # fmt: skip
    end = a if along < 0.0 else b
    value = math.hypot(points[point, 0] - points[end, 0], points[point, 1] - points[end, 1])
    value -= offset
    least = min(least, value)
    return add_row(rows, count, APART, point, end, -1, 0.0, 0.0, 1.0, offset, value), least


@nb.njit(cache=True, inline="always")
def _face(course: Course, k: int) -> tuple[float, float, float]:
    """Normal and offset of a cell's face."""
    return course.faces[k, 0], course.faces[k, 1], course.faces[k, 2]
