"""A robot that is known already and has the same legs: what it knows better, and what differs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from stairwright.robot.description import Robot

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
        values = {}
        for where, (a, b) in zip(("front", "rear"), pairs, strict=True):
            for part in ("thigh", "calf", "wheel"):
                mine, theirs = getattr(a, f"{part}_motor"), getattr(b, f"{part}_motor")
                values[f"{where} {part} torque [Nm]"] = mine.torque, theirs.torque
                values[f"{where} {part} speed [rad/s]"] = mine.speed, theirs.speed
                values[f"{where} {part} mass [kg]"] = getattr(a, part).mass, getattr(b, part).mass
        values["wheel radius [m]"] = robot.wheel.radius, other.wheel.radius
        values["total mass [kg]"] = robot.mass, other.mass
        for name, (mine, theirs) in values.items():
            if abs(mine - theirs) > _DIFFERS * max(abs(mine), abs(theirs)):
                notes.warn(f"{name}: {mine:.4g} here, {theirs:.4g} in the preset {other.name}")
        for where, (a, b) in zip(("front", "rear"), pairs, strict=True):
            for part in ("thigh", "calf"):
                mine, theirs = getattr(a.limits, part), getattr(b.limits, part)
                if np.abs(np.subtract(mine, theirs)).max() > _DIFFERS:
                    notes.warn(f"{where} {part} range [rad]: {_range(mine)} here, {_range(theirs)} "
                               f"in the preset {other.name}")  # fmt: skip


def _range(ends: tuple[float, float]) -> str:
    return f"{ends[0]:.4g}..{ends[1]:.4g}"
