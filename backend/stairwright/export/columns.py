"""Plans and rollouts as named columns of numbers: what CSV and NPZ hold."""

from __future__ import annotations

import numpy as np

from stairwright.arrays import Floats
from stairwright.errors import InputError
from stairwright.planning.plan import Plan
from stairwright.robot.description import JOINTS, LEGS, PLANAR_JOINTS
from stairwright.simulation.result import Rollout

FRAMES = (
    "world: x forward, y left, z up (REP-103); pitch about +y, nose-up is negative; "
    "joints turn about +y, zero: link straight down (thigh) or in line with the thigh (calf)"
)
UNITS = "SI: m, s, rad, N, Nm"
SHOWN_HALF_WIDTH = 0.5  # m of a terrain, in what shows a run in 3-D

# Names and units of the columns; an empty unit is a number without dimension.
PLAN_COLUMNS: dict[str, tuple[tuple[str, str], ...]] = {
    "progress": (("progress", "m"),),
    "time": (("time", "s"),),
    "trunk": (("x_c", "m"), ("z_c", "m"), ("pitch", "rad")),
    "q": tuple((name, "rad") for name in PLANAR_JOINTS),
    "wheels": tuple((f"{leg}_wheel_{axis}", "m") for leg in ("front", "rear") for axis in "xz"),
    "wheel_progress": (("front_wheel_progress", "m"), ("rear_wheel_progress", "m")),
    "contacts": tuple((f"{leg}_contact_{axis}", "m") for leg in ("front", "rear") for axis in "xz"),
    "com": (("com_x", "m"), ("com_z", "m")),
    "margins": (
        ("clearance_margin", "m"),
        ("com_margin", "m"),
        ("friction_margin", ""),
        ("torque_margin", "Nm"),
    ),
}
ROLLOUT_COLUMNS: dict[str, tuple[tuple[str, str], ...]] = {
    "time": (("time", "s"),),
    "progress": (("progress", "m"),),
    "base_position": tuple((f"base_{axis}", "m") for axis in "xyz"),
    "base_quaternion": tuple((f"base_q{axis}", "") for axis in "wxyz"),
    "pitch": (("pitch", "rad"),),
    "pitch_desired": (("pitch_desired", "rad"),),
    "q": tuple((name, "rad") for name in JOINTS),
    "q_desired": tuple((f"{name}_desired", "rad") for name in JOINTS),
    "dq": tuple((f"{name}_speed", "rad_per_s") for name in JOINTS),
    "torque": tuple((f"{name}_torque", "Nm") for name in JOINTS),
    "contact_force": tuple((f"{leg}_force_{axis}", "N") for leg in LEGS for axis in "xz"),
    "progress_desired": (("progress_desired", "m"),),
}


def plan_arrays(plan: Plan) -> dict[str, Floats]:
    """Arrays of all poses, named as in the contract; `trunk` is x_c, z_c, pitch.

    ``margins`` are clearance, com, friction, torque. The first axis is the pose.

    Raises:
        InputError: If poses have other collision points than the robot.
    """
    n = len(plan.poses)
    points = plan.robot_description.points.count
    rows: dict[str, tuple[list[object], tuple[int, ...]]] = {
        "progress": ([p.progress for p in plan.poses], ()),
        "time": ([p.time for p in plan.poses], ()),
        "trunk": ([(p.x_c, p.z_c, p.pitch) for p in plan.poses], (3,)),
        "q": ([p.q for p in plan.poses], (4,)),
        "wheels": ([p.wheels for p in plan.poses], (2, 2)),
        "wheel_progress": ([p.wheel_progress for p in plan.poses], (2,)),
        "contacts": ([p.contacts for p in plan.poses], (2, 2)),
        "com": ([p.com for p in plan.poses], (2,)),
        "collision_points": ([p.collision_points for p in plan.poses], (points, 2)),
        "margins": (
            [
                (m.clearance, m.com, m.friction, m.torque)
                for m in (pose.margins for pose in plan.poses)
            ],
            (4,),
        ),
    }
    return {name: _array(name, values, (n, *shape)) for name, (values, shape) in rows.items()}


def _array(name: str, values: list[object], shape: tuple[int, ...]) -> Floats:
    try:
        return np.asarray(values, dtype=float).reshape(shape)
    except ValueError:
        raise InputError(f"{name} must have the shape {shape}", ("poses",)) from None


def rollout_arrays(rollout: Rollout) -> dict[str, Floats]:
    """Arrays of the series, named as in the contract. The first axis is time."""
    return {name: np.asarray(getattr(rollout.series, name), float) for name in ROLLOUT_COLUMNS}


def table(
    arrays: dict[str, Floats], columns: dict[str, tuple[tuple[str, str], ...]]
) -> tuple[list[str], Floats]:
    """Header names with units, and one row a pose or sample (n, k)."""
    header = [
        f"{name}_{unit}" if unit else name for group in columns.values() for name, unit in group
    ]
    count = len(next(iter(arrays.values())))
    parts = [arrays[name].reshape(count, len(group)) for name, group in columns.items()]
    return header, np.concatenate(parts, axis=1)
