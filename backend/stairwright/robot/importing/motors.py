"""Torque and speed limits, wherever a file has them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import mujoco

from .report import Notes
from .source import Source

# Of MuJoCo's enumerations, whose members do not compare with NumPy's integers.
_AT_JOINTS = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))
_PLAIN = (
    int(mujoco.mjtGain.mjGAIN_FIXED), int(mujoco.mjtBias.mjBIAS_NONE), int(mujoco.mjtDyn.mjDYN_NONE)
)  # fmt: skip
_PLACEHOLDER_SPEED = 100.0  # rad/s; no joint of a legged robot is as fast
_PLACEHOLDER_TORQUE = 1000.0  # Nm


@dataclass(frozen=True)
class Drive:
    """A joint's motor as the file has it.

    Attributes:
        torque: [Nm], None if the file says nothing.
        speed: [rad/s], None if the file says nothing.
        armature: [kg m^2]
        damping: [Nm s/rad]
        friction: dry [Nm]
    """

    torque: float | None
    speed: float | None
    armature: float
    damping: float
    friction: float


def read_drive(source: Source, joint: int, notes: Notes) -> Drive:
    """The motor of a hinge; every contradiction is noted."""
    model, name = source.model, source.joint(joint)
    dof = int(model.jnt_dofadr[joint])
    places: dict[str, float] = {}
    armature = float(model.dof_armature[dof])
    for k in range(model.nactuator):
        if int(model.actuator_trntype[k]) not in _AT_JOINTS or model.actuator_trnid[k, 0] != joint:
            continue
        places |= _of_actuator(model, k, name, notes)
        gear = float(model.actuator_gear[k, 0])
        armature += float(model.actuator_armature[k]) * gear**2
    limit = source.limits.get(name)
    if limit is not None:
        if limit.effort > 0:
            places["<limit effort>"] = limit.effort
    elif model.jnt_actfrclimited[joint]:
        places["the joint's actuatorfrcrange"] = _smaller(
            model.jnt_actfrcrange[joint], name, "actuatorfrcrange", notes
        )
    torque = _least(places, name, notes)
    speed = limit.velocity if limit is not None and limit.velocity > 0 else None
    if speed is not None and speed >= _PLACEHOLDER_SPEED:
        notes.warn(f"{name!r}: {speed:g} rad/s looks like a placeholder, not a motor's speed")
    return Drive(torque, speed, armature, float(model.dof_damping[dof]),
                 float(model.dof_frictionloss[dof]))  # fmt: skip


def _of_actuator(model: Any, k: int, joint: str, notes: Notes) -> dict[str, float]:
    """Limits of one actuator in torque at the joint, by where they stand."""
    gear = abs(float(model.actuator_gear[k, 0]))
    name = model.actuator(k).name
    found = {}
    if model.actuator_forcelimited[k]:
        found[f"forcerange of actuator {name!r}"] = gear * _smaller(
            model.actuator_forcerange[k], joint, "forcerange", notes
        )
    form = (model.actuator_gaintype[k], model.actuator_biastype[k], model.actuator_dyntype[k])
    plain = tuple(map(int, form)) == _PLAIN
    if plain and model.actuator_ctrllimited[k]:
        gain = abs(float(model.actuator_gainprm[k, 0]))
        torque = gear * gain * _smaller(model.actuator_ctrlrange[k], joint, "ctrlrange", notes)
        found[f"ctrlrange of actuator {name!r}"] = torque
    return found


def _smaller(ends: Any, joint: str, what: str, notes: Notes) -> float:
    low, high = (abs(float(end)) for end in ends)
    if not math.isclose(low, high, rel_tol=1e-6):
        notes.warn(f"{joint!r}: its {what} is {-low:g}..{high:g}, the smaller way taken for both")
    return min(low, high)


def _least(places: dict[str, float], joint: str, notes: Notes) -> float | None:
    real = {place: torque for place, torque in places.items() if 0 < torque < math.inf}
    for place, torque in real.items():
        if torque >= _PLACEHOLDER_TORQUE:
            notes.warn(f"{joint!r}: {torque:g} Nm ({place}) looks like a placeholder")
    if not real:
        return None
    place = min(real, key=real.__getitem__)
    if max(real.values()) > real[place] * 1.01:
        shown = ", ".join(f"{torque:g} Nm in {where}" for where, torque in real.items())
        notes.warn(f"{joint!r} has its torque limit in two places: {shown}; the smallest taken")
    return real[place]
