"""What of a maker's file touches what in our world."""

from __future__ import annotations

import itertools
from typing import Any

import mujoco

from stairwright.arrays import Floats
from stairwright.robot.description import LEGS
from stairwright.robot.importing.assemble import Reading

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
