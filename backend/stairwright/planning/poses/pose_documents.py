"""Completing a pose: from trunk and wheel places to the whole document, margins included."""

from __future__ import annotations

import math

import numpy as np

from stairwright.arrays import Floats
from stairwright.planning.plan import Margins, Pose
from stairwright.planning.poses.pose_search import pose_problem
from stairwright.robot.description import Robot
from stairwright.terrain.wheel_path import WheelPath

WORST = -1e3  # written where a margin has no finite value: nothing holds the robot there
# Names of the native core's record (native/include/stairwright/poses/pose_record.hpp).
_VECTORS = ("q", "wheels", "contacts", "com", "collision_points", "forces")
_MARGINS = ("clearance", "com_margin", "friction_margin", "torque_margin")


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
    placed = np.hstack([trunks, wheels])
    record = pose_problem(robot, path).pose_records(friction, placed, joints)
    vectors = zip(*(record[name].tolist() for name in _VECTORS), strict=True)
    margins = zip(*(record[name].tolist() for name in _MARGINS), strict=True)
    progress = (wheels.mean(axis=1) - wheels[0].mean()).tolist()
    rows = zip(placed.tolist(), progress, times.tolist(), vectors, margins, strict=True)
    return [_pose(*row) for row in rows]


def _pose(
    placed: list[float], progress: float, time: float, vectors: tuple[list[list[float]], ...],
    margins: tuple[float, ...],
) -> Pose:  # fmt: skip
    """The document of one pose; the values are ours: validating takes as long as finding them."""
    q, wheels, contacts, com, points, forces = vectors
    clearance, *others = margins
    return Pose.trusted(
        progress=progress,
        time=time,
        x_c=placed[0],
        z_c=placed[1],
        pitch=placed[2],
        q=tuple(q),
        wheels=_pairs(wheels),
        wheel_progress=(placed[3], placed[4]),
        contacts=_pairs(contacts),
        com=tuple(com),
        collision_points=[(x, z) for x, z in points],
        forces=_pairs(forces),
        margins=Margins.trusted(
            clearance=clearance,
            **dict(zip(("com", "friction", "torque"), map(_finite, others), strict=True)),
        ),
    )


def _finite(value: float) -> float:
    return max(value, WORST) if math.isfinite(value) else WORST


def _pairs(rows: list[list[float]]) -> tuple[tuple[float, float], tuple[float, float]]:
    (a, b), (c, d) = rows
    return (a, b), (c, d)
