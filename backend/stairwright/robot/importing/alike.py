"""A robot that is known already and has the same legs: what it knows better, and what differs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from stairwright.robot.description import Robot
from stairwright.robot.legs import Leg

from .pair import Pair
from .report import Notes

_SAME = 2e-3  # m
_DIFFERS = 0.02  # share


@dataclass(frozen=True)
class Alike:
    """A known robot whose hips and links are as far apart."""

    robot: Robot

    @property
    def motors(self) -> dict[str, Any]:
        """Its motors by part, and its name."""
        motors = {
            part: self.robot.actuators.of(part).model_dump() for part in ("thigh", "calf", "wheel")
        }
        return {**motors, "name": self.robot.name}


def find_alike(pairs: tuple[Pair, Pair], known: Sequence[Robot]) -> Alike | None:
    """The known robot with the same lengths, if there is one."""
    front, rear = pairs
    own = [*front.lengths, *rear.lengths, float(np.hypot(*(front.hip - rear.hip)))]
    for robot in known:
        legs = robot.legs
        theirs = [leg_length for leg in legs for leg_length in (leg.thigh.length, leg.calf.length)]
        theirs.append(float(np.hypot(*np.subtract(legs[0].hip, legs[1].hip))))
        if np.abs(np.subtract(own, theirs)).max() < _SAME:
            return Alike(robot)
    return None


def note_differences(robot: Robot, known: Sequence[Robot], notes: Notes) -> None:
    """Where the sources of what seems the same robot contradict each other."""
    for other in known:
        pairs = list(zip(robot.legs, other.legs, strict=True))
        lengths = [
            abs(getattr(a, part).length - getattr(b, part).length)
            for a, b in pairs for part in ("thigh", "calf")
        ]  # fmt: skip
        hips = [float(np.abs(np.subtract(a.hip, b.hip)).max()) for a, b in pairs]
        if max(*lengths, *hips) >= _SAME:
            continue
        remarks = [_contradictions(a, b, other.name) for a, b in pairs]
        alike = [remark for remark in remarks[0] if remark in remarks[1]]
        for remark in alike:
            notes.warn(remark)
        for where, own in zip(("front", "rear"), remarks, strict=True):
            for remark in own:
                if remark not in alike:
                    notes.warn(f"{where} {remark}")
        for name, mine, theirs in (
            ("wheel radius [m]", robot.wheel.radius, other.wheel.radius),
            ("total mass [kg]", robot.mass, other.mass),
        ):
            if _differ(mine, theirs):
                notes.warn(f"{name}: {mine:.4g} here, {theirs:.4g} in the preset {other.name}")


def _contradictions(own: Leg, other: Leg, name: str) -> list[str]:
    """What two sources tell unlike of a leg."""
    found = []
    for part in ("thigh", "calf", "wheel"):
        mine, theirs = getattr(own, f"{part}_motor"), getattr(other, f"{part}_motor")
        for what, a, b in (
            ("torque [Nm]", mine.torque, theirs.torque),
            ("speed [rad/s]", mine.speed, theirs.speed),
            ("mass [kg]", getattr(own, part).mass, getattr(other, part).mass),
        ):
            if _differ(a, b):
                found.append(f"{part} {what}: {a:.4g} here, {b:.4g} in the preset {name}")
    for part in ("thigh", "calf"):
        a, b = getattr(own.limits, part), getattr(other.limits, part)
        if np.abs(np.subtract(a, b)).max() > _DIFFERS:
            found.append(f"{part} range [rad]: {_range(a)} here, {_range(b)} in the preset {name}")
    return found


def _differ(mine: float, theirs: float) -> bool:
    return abs(mine - theirs) > _DIFFERS * max(abs(mine), abs(theirs))


def _range(ends: tuple[float, float]) -> str:
    return f"{ends[0]:.4g}..{ends[1]:.4g}"
