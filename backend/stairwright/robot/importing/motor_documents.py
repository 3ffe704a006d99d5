"""The motors of a robot's document: what the file has, and what is taken where it has nothing."""

from __future__ import annotations

from typing import Any

from stairwright._core import GRAVITY

from .motors import Drive
from .pair import Pair
from .report import Notes

_SPEEDS = {"thigh": 20.0, "calf": 20.0, "wheel": 30.0}  # rad/s, of what is on the market
_LEVERS = {
    "thigh": "0.7 of the leg's length",
    "calf": "0.7 of the leg's length",
    "wheel": "the wheel's radius",
}
_ROTOR = 0.01 / 33.5  # kg m^2 per Nm, the A1's leg motors
_MOST_TORQUE, _MOST_SPEED, _MOST_ROTOR, _MOST_DAMPING = 1000.0, 1000.0, 10.0, 10.0


def actuators(
    pair: Pair, radius: float, mass: float, kind: str, known: dict[str, Any], notes: Notes
) -> dict[str, Any]:
    """Motors of thigh, calf and wheel.

    Args:
        pair: Front or rear legs.
        radius: Of the wheels [m].
        mass: Of the robot [kg].
        kind: urdf or mjcf.
        known: What another robot with these legs has: ``{"calf": {"speed": 20.0}}``, and its name.
        notes: For remarks.
    """
    made = {}
    for part in ("thigh", "calf", "wheel"):
        drive: Drive = getattr(pair, part).drive
        arm = radius if part == "wheel" else 0.7 * sum(pair.lengths)
        path = f"{pair.path}actuators.{part}"
        made[part] = _motor(part, path, drive, arm * mass * GRAVITY / 2, kind, known, notes)
    return made


def _motor(
    part: str, path: str, drive: Drive, plenty: float, kind: str, known: dict[str, Any],
    notes: Notes,
) -> dict[str, Any]:  # fmt: skip
    own, name = known.get(part, {}), known.get("name")
    torque, speed = drive.torque, drive.speed
    if torque is None:
        torque = own.get("torque") or plenty
        plain = f"what holds half the weight at {_LEVERS[part]}"
        why = f"as the preset {name}, which has the same legs" if own else plain
        notes.assume(f"{part} torque {torque:.4g} Nm: the file has none; {why}", f"{path}.torque")
    if speed is None:
        speed = own.get("speed") or _SPEEDS[part]
        why = f"as the preset {name}, which has the same legs" if own else "usual for such motors"
        text = f"{part} speed {speed:.4g} rad/s: {kind.upper()} names none; {why}"
        notes.assume(text, f"{path}.speed")
    armature = drive.armature
    if kind == "urdf" and armature == 0.0:
        armature = own.get("armature") or _ROTOR * torque
        why = f"as the preset {name}" if own else "in the A1's ratio to its torque"
        text = f"{part} rotor inertia {armature:.3g} kg m^2: URDF has no place for it; {why}"
        notes.assume(text, f"{path}.armature")
    if drive.friction > 0:
        notes.assume(f"{part}: dry friction of {drive.friction:.3g} Nm in the joint is left out")
    if drive.damping > _MOST_DAMPING:
        notes.warn(f"{part}: damping {drive.damping:g} Nm s/rad is cut to {_MOST_DAMPING:g}")
    return {
        "torque": min(torque, _MOST_TORQUE),
        "speed": min(speed, _MOST_SPEED),
        "armature": min(armature, _MOST_ROTOR),
        "damping": min(drive.damping, _MOST_DAMPING),
    }
