"""What the robot does over time, from a plan or a rollout document: the thing that is played."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from stairwright.arrays import Floats
from stairwright.documents import parse
from stairwright.planning.carrying import carrying_normals
from stairwright.planning.plan import Plan
from stairwright.planning.poses.interpolation import reference
from stairwright.robot.description import Robot
from stairwright.robot.spatial import lift
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import wheel_path


@dataclass(frozen=True)
class Moment:
    """One state: base position (3,), quaternion wxyz (4,), joints (12,), forces (4, 2) or None."""

    position: Floats
    quaternion: Floats
    q: Floats
    forces: Floats | None


@dataclass(frozen=True)
class Motion:
    """States over time. SI units, world frame, quaternions wxyz, joints in the contract's order.

    Attributes:
        time: (n,) [s], rising strictly.
        progress: (n,) mean arc length of the wheels [m], never falling.
        position: (n, 3) trunk point.
        quaternion: (n, 4).
        q: (n, 12).
        forces: (n, 4, 2) force of the terrain on each wheel, world x and z [N], or None.
    """

    time: Floats
    progress: Floats
    position: Floats
    quaternion: Floats
    q: Floats
    forces: Floats | None

    @property
    def duration(self) -> float:
        """Time of the last state [s]."""
        return float(self.time[-1])

    def at(self, time: float) -> Moment:
        """The state at `time`, interpolated; held beyond both ends."""
        n = len(self.time)
        if n == 1:
            i, j, share = 0, 0, 0.0
        else:
            j = int(np.clip(np.searchsorted(self.time, time, side="right"), 1, n - 1))
            i = j - 1
            step = self.time[j] - self.time[i]
            share = float(np.clip((time - self.time[i]) / step, 0.0, 1.0))
        mix = _Mix(i, j, share)
        before, after = self.quaternion[i], self.quaternion[j]
        if float(before @ after) < 0.0:
            after = -after
        quaternion = (1 - share) * before + share * after
        return Moment(
            position=mix(self.position),
            quaternion=quaternion / np.linalg.norm(quaternion),
            q=mix(self.q),
            forces=None if self.forces is None else mix(self.forces),
        )

    def progress_at(self, time: float) -> float:
        """Progress [m] at `time`."""
        return float(np.interp(time, self.time, self.progress))

    def time_at(self, progress: float) -> float:
        """The first time at which `progress` [m] is reached."""
        i = int(np.searchsorted(self.progress, progress, side="left"))
        if i <= 0:
            return float(self.time[0])
        if i >= len(self.progress):
            return self.duration
        step = self.progress[i] - self.progress[i - 1]
        share = (progress - self.progress[i - 1]) / step if step > 0 else 0.0
        return float(self.time[i - 1] + share * (self.time[i] - self.time[i - 1]))


class _Mix:
    def __init__(self, i: int, j: int, share: float) -> None:
        self.i, self.j, self.share = i, j, share

    def __call__(self, values: Floats) -> Floats:
        mixed: Floats = (1 - self.share) * values[self.i] + self.share * values[self.j]
        return mixed


def from_plan(plan: Mapping[str, Any], robot: Robot) -> Motion | None:
    """The planned motion; None for a plan without poses. Time is the poses' planned time."""
    poses = plan["poses"]
    if not poses:
        return None
    progress = np.array([pose["progress"] for pose in poses], float)
    time = _rising(np.array([pose.get("time", 0.0) for pose in poses], float), progress)
    trunk = np.array([(pose["x_c"], pose["z_c"], pose["pitch"]) for pose in poses], float)
    q = np.array([pose["q"] for pose in poses], float)
    rolled = np.array([pose["wheel_progress"] for pose in poses], float)
    forces = None
    if all(pose.get("forces") is not None for pose in poses):
        path = wheel_path(parse(Terrain, plan["terrain"]), robot.wheel.radius)
        local = np.array([pose["forces"] for pose in poses], float)
        forces = _per_wheel(local, carrying_normals(path, robot.mass, rolled, local))
    if plan["method"] != "path" and len(poses) > 1:
        # Sparse poses: play what the controller tracks, with the wheels on the terrain.
        dense = reference(parse(Plan, dict(plan)), joint_rate=None)
        time = np.interp(dense.progress, progress, time)
        progress, trunk, q = dense.progress, dense.trunk, dense.q
        rolled, forces = dense.wheel_progress, _per_wheel(dense.forces, dense.normals)
    position, quaternion, joints = lift(robot, trunk, q, rolled)
    return Motion(time, progress, position, quaternion, joints, forces)


def from_rollout(rollout: Mapping[str, Any]) -> Motion | None:
    """The simulated motion; None for a rollout without samples."""
    series = rollout["series"]
    time = np.asarray(series["time"], float)
    if len(time) == 0:
        return None
    progress = np.maximum.accumulate(np.asarray(series["progress"], float))
    return Motion(
        time=_rising(time, time),
        progress=progress,
        position=np.asarray(series["base_position"], float),
        quaternion=np.asarray(series["base_quaternion"], float),
        q=np.asarray(series["q"], float),
        forces=np.asarray(series["contact_force"], float),
    )


def _per_wheel(local: Floats, normals: Floats) -> Floats:
    """World forces (n, 4, 2) of the wheels from tangential and normal ones of pairs (n, 2, 2)."""
    tangents = np.stack([normals[..., 1], -normals[..., 0]], axis=-1)
    pairs = local[..., :1] * tangents + local[..., 1:] * normals
    shared: Floats = np.repeat(pairs, 2, axis=1) / 2
    return shared


def _rising(time: Floats, fallback: Floats) -> Floats:
    """Strictly rising times; poses without planned times run at 0.12 m/s."""
    if len(time) > 1 and time[-1] <= time[0]:
        time = (fallback - fallback[0]) / 0.12
    rising: Floats = np.maximum.accumulate(time) + 1e-9 * np.arange(len(time))
    return rising
