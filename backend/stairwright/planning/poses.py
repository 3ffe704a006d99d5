"""Completing a pose: from trunk and wheel places to the whole document, margins included."""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.robot.description import Robot
from stairwright.statics.margin import friction_needed
from stairwright.terrain.wheel_path import WheelPath, curve_at

from .clearance import least_clearance
from .plan import Margins, Pose
from .sqp.cells import Course, make_course
from .sqp.places import CONTACTS, contacts, room
from .sqp.state import HIP, POINTS, Body, com, make_body, new_state, place, stand_on
from .supports import contact_forces, gentlest_forces, torque_margin, weight_of

Floats = NDArray[np.float64]

WORST = -1e3  # written where a margin has no finite value: nothing holds the robot there
_SNAP = 1e-6  # rad; a joint that far beyond its limit is put onto it
_Q, _WHEELS, _CONTACTS, _FORCES, _COM, _MARGINS, _RECORD = 0, 4, 8, 12, 16, 18, 22


def complete_poses(
    robot: Robot, path: WheelPath, friction: float, trunks: Floats, wheels: Floats, joints: Floats,
    times: Floats,
) -> list[Pose]:  # fmt: skip
    """Pose documents of trunk poses with the wheels at places of the wheel-centre curve.

    Args:
        robot: The robot.
        path: The wheel-centre curve.
        friction: Between wheels and terrain.
        trunks: (n, 3) x, z [m] and pitch [rad].
        wheels: (n, 2) arc lengths of the front and the rear wheels [m].
        joints: (n, 4) planar joints [rad], which count where a wheel is out of reach.
        times: (n,) planned times since the start [s].
    """
    records = np.empty((len(trunks), _RECORD))
    points = np.empty((len(trunks), robot.collision_points.count, 2))
    _measure_all(
        make_body(robot), make_course(path), friction, weight_of(robot),
        np.hstack([trunks, wheels]), joints, records, points,
    )  # fmt: skip
    progress = wheels.mean(axis=1) - wheels[0].mean()
    columns = (trunks, wheels, records, points, progress, times)
    return [_pose(*row) for row in zip(*(column.tolist() for column in columns), strict=True)]


def _pose(
    trunk: list[float], wheels: list[float], r: list[float], points: list[list[float]],
    progress: float, time: float,
) -> Pose:  # fmt: skip
    """The document of one pose; the values are ours: validating takes as long as finding them."""
    return Pose.trusted(
        progress=progress,
        time=time,
        x_c=trunk[0],
        z_c=trunk[1],
        pitch=trunk[2],
        q=(r[0], r[1], r[2], r[3]),
        wheels=_pairs(r[_WHEELS:_CONTACTS]),
        wheel_progress=(wheels[0], wheels[1]),
        contacts=_pairs(r[_CONTACTS:_FORCES]),
        com=(r[_COM], r[_COM + 1]),
        collision_points=[(x, z) for x, z in points],
        forces=_pairs(r[_FORCES:_COM]),
        margins=Margins.trusted(
            clearance=r[_MARGINS],
            com=_finite(r[_MARGINS + 1]),
            friction=_finite(r[_MARGINS + 2]),
            torque=_finite(r[_MARGINS + 3]),
        ),
    )


@nb.njit(cache=True)
def _measure_all(
    body: Body, course: Course, friction: float, weight: float, y: Floats, q: Floats,
    records: Floats, points: Floats,
) -> None:  # fmt: skip
    """`_measure` for each row."""
    for i in range(len(y)):
        _measure(body, course, friction, weight, y[i], q[i], records[i], points[i])


@nb.njit(cache=True)
def _measure(
    body: Body, course: Course, friction: float, weight: float, y: Floats, q: Floats,
    record: Floats, collision: Floats,
) -> None:  # fmt: skip
    """Fill the numbers of one pose.

    Args:
        body: The robot.
        course: The terrain.
        friction: Between wheels and terrain.
        weight: Of the robot [N].
        y: (5,) x, z, pitch, arc lengths of front and rear wheels.
        q: (4,) joints where a wheel is out of reach.
        record: (_RECORD,) joints, wheel centres, contacts, forces, CoM, margins.
        collision: (n, 2) collision points.
    """
    st = new_state(body, False)
    place(body, course, y, st)
    stand_on(body, q, _SNAP, st)
    record[_Q:_WHEELS] = st.q
    at, n = np.empty((1, 2, 2)), np.empty((1, 2, 2))
    for leg in range(2):
        x, z, nx, nz = curve_at(course.pieces, course.radius, y[3 + leg])
        at[0, leg, 0], at[0, leg, 1] = x - course.radius * nx, z - course.radius * nz
        n[0, leg, 0], n[0, leg, 1] = nx, nz
    centre = com(st, 0)
    record[_WHEELS:_CONTACTS] = st.points[HIP + 4 : HIP + 6].ravel()
    record[_CONTACTS:_FORCES] = at.ravel()
    record[_FORCES:_COM] = contact_forces(weight, np.array([centre]), at, n).ravel()
    record[_COM], record[_COM + 1] = centre, com(st, 1)
    collision[:] = st.points[POINTS:]

    points, normals = np.empty((CONTACTS, 2)), np.empty((CONTACTS, 2))
    owner, forces = np.empty(CONTACTS, np.int64), np.empty((CONTACTS, 2))
    count = contacts(course, y[3], y[4], points, normals, owner)
    low, high = room(course, y[3], y[4], friction)
    record[_MARGINS] = _clearance(body, course, st.points)
    record[_MARGINS + 1] = -np.inf if low > high else min(centre - low, high - centre)
    record[_MARGINS + 2] = friction - friction_needed(points, normals, count, centre)
    record[_MARGINS + 3] = -np.inf
    if gentlest_forces(points, normals, owner, count, centre, forces):
        record[_MARGINS + 3] = torque_margin(
            body.planar, st.points[HIP:POINTS], points, normals, owner, count, weight * forces
        )


@nb.njit(cache=True)
def _clearance(body: Body, course: Course, points: Floats) -> float:
    """Least distance of trunk and links from the terrain [m]."""
    segments, radii = np.empty((8, 2, 2)), np.zeros(8)
    for k in range(4):
        segments[k, 0], segments[k, 1] = points[k], points[(k + 1) % 4]
        leg, upper = k // 2, k % 2 == 0
        a = HIP + leg if upper else HIP + 2 + leg
        segments[4 + k, 0], segments[4 + k, 1] = points[a], points[a + 2]
        radii[4 + k] = body.planar.thigh_radius if upper else body.planar.calf_radius
    return least_clearance(course.vertices, segments, radii)[0]


def _finite(value: float) -> float:
    return max(value, WORST) if math.isfinite(value) else WORST


def _pairs(row: list[float]) -> tuple[tuple[float, float], tuple[float, float]]:
    return (row[0], row[1]), (row[2], row[3])
