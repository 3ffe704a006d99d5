"""One pose of the optimisation: legs in closed form, and how every point of the robot moves.

The joints are eliminated: unknown are y = (x, z, pitch, s_front, s_rear), with the wheels on the
wheel-centre curve (eq 19) by construction. Points are sums of vectors that each turn with one
absolute angle (pitch, front thigh, front calf, rear thigh, rear calf); all turn about +y, where
v' = (v_z, -v_x) and v'' = -v.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.planning.path.legs import Leg, calf_joint, knee_point, make_legs, thigh_joint
from stairwright.robot.description import Planar, Robot
from stairwright.terrain.wheel_path import curve_at

from .cells import Course

Floats = NDArray[np.float64]

ANGLES = 5  # pitch, front thigh, front calf, rear thigh, rear calf (absolute)
HIP, KNEE, WHEEL, POINTS = 4, 6, 8, 10  # indices of points: 0-3 corners of the trunk; + leg


class Body(NamedTuple):
    """The robot, for compiled code; lengths in m.

    Attributes:
        planar: Dimensions, masses and limits.
        front, rear: The legs.
        trunk: (a, 2) collision points on the trunk, in its frame.
        thigh, calf: Collision points on the links, as shares of the link.
        standing: (4,) joints of the nominal pose [rad].
    """

    planar: Planar
    front: Leg
    rear: Leg
    trunk: Floats
    thigh: Floats
    calf: Floats
    standing: Floats


def make_body(robot: Robot) -> Body:
    """The numbers of a robot."""
    p, points = robot.planar, robot.collision_points
    legs, drop = make_legs(p), p.wheel_radius - p.nominal_height
    standing = []
    for leg in legs:  # wheels below the hips, trunk level
        x, z = knee_point(0.0, drop - leg.hip_z, p.thigh, p.calf, leg.knee)
        standing.append(thigh_joint(x, z, 0.0, leg))
        standing.append(calf_joint(0.0, drop - leg.hip_z, p.thigh, p.calf, leg.knee))
    size = np.array([2 * p.half_length, 2 * p.half_height])
    return Body(
        p,
        *legs,
        np.asarray(points.trunk, float).reshape(-1, 2) * size,
        np.asarray(points.thigh, float),
        np.asarray(points.calf, float),
        np.array(standing),
    )


class State(NamedTuple):
    """A pose and its derivatives; filled by `place`.

    Attributes:
        y: (5,) x, z, pitch, s_front, s_rear.
        angles: (5,) absolute angles [rad].
        q: (4,) joints [rad].
        points: (n, 2) points in the world: corners of the trunk, hips, knees, wheels, and the
            collision points if they count.
        arms: (n, 5, 2) the part of each point that turns with each angle.
        normals: (6, 2) directions that turn with the robot: along and up the trunk, and across
            each of the four links.
        curve: (2, 3) tangent (x, z) and curvature of the wheel-centre curve at the wheels.
        contact: (2,) x of the rear contact, and its derivative by s_rear.
        turns: (4, 5) derivative of the four link angles by y.
        reached: (2,) 1 where the leg reaches its wheel.
        shares: (4,) of the mass that count at the trunk, and at each hip, knee and wheel.
    """

    y: Floats
    angles: Floats
    q: Floats
    points: Floats
    arms: Floats
    normals: Floats
    curve: Floats
    contact: Floats
    turns: Floats
    reached: Floats
    shares: Floats


@nb.njit(cache=True)
def new_state(body: Body, links: bool) -> State:
    """An empty state; without `links` it has room for the collision points."""
    n = POINTS
    if not links:
        n += len(body.trunk) + 2 * (len(body.thigh) + len(body.calf))
    return State(
        np.zeros(5), np.zeros(5), np.zeros(4), np.zeros((n, 2)), np.zeros((n, ANGLES, 2)),
        np.zeros((6, 2)), np.zeros((2, 3)), np.zeros(2), np.zeros((4, 5)),
        np.zeros(2), _shares(body.planar),
    )  # fmt: skip


@nb.njit(cache=True)
def _shares(p: Planar) -> Floats:
    thigh, calf = p.thigh_mass / p.mass, p.calf_mass / p.mass
    hip, wheel = thigh * (1.0 - p.thigh_com), calf * p.calf_com + p.wheel_mass / p.mass
    knee = thigh * p.thigh_com + calf * (1.0 - p.calf_com)
    return np.array([p.trunk_mass / p.mass, hip, knee, wheel])


@leaf
def com(st: State, axis: int) -> float:
    """Centre of mass of the whole robot along x (0) or z (1) [m]."""
    total = st.shares[0] * st.y[axis]
    for leg in range(2):
        for k in range(3):
            total += st.shares[1 + k] * st.points[HIP + 2 * k + leg, axis]
    return float(total)


@leaf
def place(body: Body, course: Course, y: Floats, st: State) -> bool:
    """Fill `st` for the unknowns `y`; False where a leg cannot reach its wheel."""
    p = body.planar
    for k in range(5):
        st.y[k] = y[k]
    c, s = math.cos(y[2]), math.sin(y[2])
    st.angles[0] = y[2]
    st.normals[0, 0], st.normals[0, 1] = c, -s
    st.normals[1, 0], st.normals[1, 1] = s, c
    for k in range(4):
        u = p.half_length if k == 0 or k == 3 else -p.half_length
        v = p.half_height if k < 2 else -p.half_height
        _on_trunk(st, k, c * u + s * v, c * v - s * u)
    for leg in range(2):
        limb = body.front if leg == 0 else body.rear
        hip, knee, wheel = HIP + leg, KNEE + leg, WHEEL + leg
        _on_trunk(st, hip, c * limb.hip_x + s * limb.hip_z, c * limb.hip_z - s * limb.hip_x)
        wx, wz, nx, nz = curve_at(course.pieces, course.radius, y[3 + leg])
        k = int(np.searchsorted(course.pieces[:, 1], y[3 + leg], side="right")) - 1
        bent = course.pieces[min(max(k, 0), len(course.pieces) - 1), 0] == 1.0
        st.curve[leg, 0], st.curve[leg, 1] = nz, -nx
        st.curve[leg, 2] = 1.0 / course.radius if bent else 0.0
        if leg == 1:
            st.contact[0], st.contact[1] = wx - course.radius * nx, 0.0 if bent else nz
        hx, hz = st.points[hip, 0], st.points[hip, 1]
        dx, dz = wx - hx, wz - hz
        d = math.hypot(dx, dz)
        if not abs(p.thigh - p.calf) + 1e-6 < d < p.thigh + p.calf - 1e-6:
            st.reached[leg] = 0.0
            continue
        st.reached[leg] = 1.0
        kx, kz = knee_point(dx, dz, p.thigh, p.calf, limb.knee)
        st.q[2 * leg] = thigh_joint(kx, kz, y[2], limb)
        st.q[2 * leg + 1] = calf_joint(dx, dz, p.thigh, p.calf, limb.knee)
        st.angles[1 + 2 * leg] = y[2] + st.q[2 * leg]
        st.angles[2 + 2 * leg] = st.angles[1 + 2 * leg] + st.q[2 * leg + 1]
        st.points[knee, 0], st.points[knee, 1] = hx + kx, hz + kz
        st.points[wheel, 0], st.points[wheel, 1] = wx, wz
        for point in (knee, wheel):
            st.arms[point, 0, 0], st.arms[point, 0, 1] = st.arms[hip, 0, 0], st.arms[hip, 0, 1]
            st.arms[point, 1 + 2 * leg, 0], st.arms[point, 1 + 2 * leg, 1] = kx, kz
        st.arms[wheel, 2 + 2 * leg, 0] = dx - kx
        st.arms[wheel, 2 + 2 * leg, 1] = dz - kz
        # Across thigh and calf: the link's direction turned by a right angle.
        st.normals[2 + 2 * leg, 0], st.normals[2 + 2 * leg, 1] = kz / p.thigh, -kx / p.thigh
        st.normals[3 + 2 * leg, 0] = (dz - kz) / p.calf
        st.normals[3 + 2 * leg, 1] = -(dx - kx) / p.calf
        _turns(st, leg)
    if st.reached[0] + st.reached[1] < 2.0:
        return False
    _collision_points(body, st, c, s)
    return True


@leaf
def _on_trunk(st: State, k: int, rx: float, rz: float) -> None:
    st.points[k, 0], st.points[k, 1] = st.y[0] + rx, st.y[1] + rz
    st.arms[k, 0, 0], st.arms[k, 0, 1] = rx, rz


@leaf
def _turns(st: State, leg: int) -> None:
    """Link angles of a leg as the unknowns change: the wheel stays on the curve."""
    wheel, upper = WHEEL + leg, 1 + 2 * leg
    ax, az = st.arms[wheel, upper, 1], -st.arms[wheel, upper, 0]
    bx, bz = st.arms[wheel, upper + 1, 1], -st.arms[wheel, upper + 1, 0]
    det = ax * bz - az * bx
    for j in range(5):
        if j == 0:
            rx, rz = -1.0, 0.0
        elif j == 1:
            rx, rz = 0.0, -1.0
        elif j == 2:
            rx, rz = -st.arms[wheel, 0, 1], st.arms[wheel, 0, 0]
        elif j == 3 + leg:
            rx, rz = st.curve[leg, 0], st.curve[leg, 1]
        else:
            rx, rz = 0.0, 0.0
        st.turns[2 * leg, j] = (rx * bz - rz * bx) / det
        st.turns[2 * leg + 1, j] = (ax * rz - az * rx) / det


@leaf
def _collision_points(body: Body, st: State, c: float, s: float) -> None:
    """Fill the collision points, if the state has room for them."""
    k = POINTS
    if len(st.points) == k:
        return
    for i in range(len(body.trunk)):
        u, v = body.trunk[i, 0], body.trunk[i, 1]
        _on_trunk(st, k, c * u + s * v, c * v - s * u)
        k += 1
    for leg in range(2):
        for link in range(2):
            shares = body.thigh if link == 0 else body.calf
            a, b = (HIP + leg, KNEE + leg) if link == 0 else (KNEE + leg, WHEEL + leg)
            for share in shares:
                for i in range(2):
                    st.points[k, i] = st.points[a, i] + share * (st.points[b, i] - st.points[a, i])
                    for j in range(ANGLES):
                        st.arms[k, j, i] = st.arms[a, j, i] + share * (
                            st.arms[b, j, i] - st.arms[a, j, i]
                        )
                k += 1


@leaf
def stand_on(body: Body, q: Floats, rounding: float, st: State) -> None:
    """Set the joints of a placed state: those that reach, else `q`; rounding errors at limits go.

    Points are moved to where the joints put them.

    Args:
        body: The robot.
        q: (4,) joints of a leg that does not reach its wheel [rad].
        rounding: A joint that little beyond its limit is put onto it [rad].
        st: The state, after `place`.
    """
    p = body.planar
    c, s = math.cos(st.y[2]), math.sin(st.y[2])
    for leg in range(2):
        limb = body.front if leg == 0 else body.rear
        _on_trunk(st, HIP + leg, c * limb.hip_x + s * limb.hip_z, c * limb.hip_z - s * limb.hip_x)
        angle, at = st.y[2], HIP + leg
        for link in range(2):
            k = 2 * leg + link
            low = limb.thigh_min if link == 0 else limb.calf_min
            high = limb.thigh_max if link == 0 else limb.calf_max
            joint = st.q[k] if st.reached[leg] > 0.0 else q[k]
            inside = min(max(joint, low), high)
            st.q[k] = inside if abs(joint - inside) < rounding else joint
            angle += st.q[k]
            length = p.thigh if link == 0 else p.calf
            st.points[at + 2, 0] = st.points[at, 0] - length * math.sin(angle)
            st.points[at + 2, 1] = st.points[at, 1] - length * math.cos(angle)
            at += 2
    _collision_points(body, st, c, s)
