"""What of a maker's file touches what in our world."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np

from stairwright.arrays import Floats
from stairwright.robot.description import LEGS, Robot
from stairwright.robot.importing.assemble import Reading
from stairwright.robot.kinematics import all_joints, standing_joints

BALLS = 2  # MuJoCo's bit of what they collide with


def join_held(spec: Any, reading: Reading, bodies: list[Any], labels: dict[str, str]) -> None:
    """What held joints part is one: it touches neither itself nor, as a leg's link, the next."""
    model = reading.source.model
    parts: dict[str, list[str]] = {}
    for body in bodies[1:]:
        if list(body.geoms):
            parts.setdefault(labels[body.name], []).append(body.name)
    parted = {labels[bodies[int(model.jnt_bodyid[joint])].name] for joint in reading.held}
    pairs = [pair for part in parted for pair in itertools.combinations(parts.get(part, []), 2)]
    for leg in LEGS:
        chain = [f"{leg}_{part}" for part in ("thigh", "calf", "wheel")]
        for first, second in itertools.pairwise(chain):
            if not parted.isdisjoint((first, second)):
                pairs += itertools.product(parts.get(first, []), parts.get(second, []))
    for one, other in pairs:
        spec.add_exclude(bodyname1=one, bodyname2=other)


def add_ball(wheel: Any, place: Floats, radius: float) -> None:
    """A ball is as wide as it is high, which no wheel is: it touches terrain and balls alone."""
    for geom in list(wheel.geoms):
        geom.contype = geom.conaffinity = 0
    wheel.add_geom(
        type=mujoco.mjtGeom.mjGEOM_SPHERE, size=[radius, 0, 0], pos=place, contype=BALLS,
        conaffinity=BALLS, mass=0.0, density=0.0, condim=3,
    )  # fmt: skip


def overlapping(
    model: Any, positions_with: Callable[[Floats], Floats], robot: Robot
) -> list[tuple[str, str]]:
    """Pairs of bodies that overlap as the robot stands, or at an end of its knees' range whatever
    the thighs do: the range says that knees bend so far.

    Args:
        model: MuJoCo's model of the file in our world.
        positions_with: Its qpos, far from the ground, with our joints (12,) at these angles [rad].
        robot: The robot that the file is of.
    """
    data = mujoco.MjData(model)

    def touching(joints: Floats) -> set[tuple[int, int]]:
        data.qpos[:] = positions_with(all_joints(joints))
        mujoco.mj_forward(model, data)
        pairs = np.sort(model.geom_bodyid[data.contact.geom[data.contact.dist < 0.0]])
        return {(int(a), int(b)) for a, b in pairs if a > 0}

    found = touching(standing_joints(robot))
    for end in range(2):
        found |= set.intersection(*(touching(_bent(robot, end, k)) for k in np.linspace(0, 1, 9)))
    return [(model.body(a).name, model.body(b).name) for a, b in sorted(found)]


def _bent(robot: Robot, end: int, share: float) -> Floats:
    """(4,) knees at the lower or upper end of their range, thighs at a share of theirs [rad]."""
    legs = [leg.limits for leg in robot.legs]
    thighs = [np.interp(share, (0.0, 1.0), leg.thigh) for leg in legs]
    return np.stack([thighs, [leg.calf[end] for leg in legs]], axis=1).ravel()
