"""The robot that was made against MuJoCo's model of its file, in random postures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stairwright.arrays import Floats
from stairwright.errors import InputError
from stairwright.robot import kinematics

from .assemble import Reading
from .report import Notes

_POSTURES = 100
_MOST = 0.02  # of the leg's length; more is another robot


@dataclass(frozen=True)
class Errors:
    """The largest differences in the side view: wheel centres [m], total mass [kg], CoM [m]."""

    wheels: float
    mass: float
    com: float


def compare(reading: Reading, postures: int, seed: int = 0) -> Errors:
    """The largest errors over random postures, left and right legs alike, wheels at 0."""
    robot, source, frame = reading.robot, reading.source, reading.frame
    model, data = source.model, source.data
    random = np.random.default_rng(seed)
    bodies = [b for b in range(1, model.nbody) if model.body_rootid[b] == _root(reading)]
    masses = model.body_mass[bodies]
    zero = np.zeros(())
    wheels = com = 0.0
    for _ in range(postures):
        q = _draw(reading, random)
        source.set(reading.held | positions(reading, q))
        frames = kinematics.forward(robot, zero, zero, zero, q)
        for name, leg in reading.legs.items():
            anchor = leg.axes @ frame.place(data.xanchor[leg.chain.wheel])
            anchor[1] = reading.planes[name]
            there = (leg.axes.T @ anchor - reading.centre)[[0, 2]]
            off = there - frames.wheels[0 if name[0] == "F" else 1]
            wheels = max(wheels, float(np.hypot(*off)))
        there = (masses @ frame.place(data.xipos[bodies]) / masses.sum() - reading.centre)[[0, 2]]
        com = max(com, float(np.abs(there - kinematics.com(robot, zero, zero, zero, frames)).max()))
    source.set(reading.held)
    return Errors(wheels, abs(float(masses.sum()) - robot.mass), com)


def positions(reading: Reading, q: Floats) -> dict[int, float]:
    """The file's joints in a posture of ours; the wheels at the file's zero."""
    found = {}
    for name, leg in reading.legs.items():
        first = 0 if name[0] == "F" else 2
        for k, joint in enumerate((leg.chain.thigh, leg.chain.calf)):
            own = leg.maps[k]
            found[joint] = own.sign * (float(q[first + k]) - own.offset)
    return found


def verify(reading: Reading, notes: Notes) -> Errors:
    """Say how far the robot is from its file.

    Raises:
        InputError: If it is another robot.
    """
    found = compare(reading, _POSTURES)
    reach = min(leg.reach for leg in reading.robot.legs)
    if found.wheels > _MOST * reach:
        off = f"{1e3 * found.wheels:.3g} mm"
        raise InputError(
            f"the legs do not move in the side view: their wheels are up to {off} off", ("file",)
        )
    if found.wheels > 1e-7:
        off = f"{1e3 * found.wheels:.2g} mm"
        notes.warn(f"the robot's wheels are up to {off} off the file's in the side view")
    if found.com > 1e-6:
        notes.warn(f"its mass centre is up to {1e3 * found.com:.2g} mm off the file's")
    return found


def _root(reading: Reading) -> int:
    model = reading.source.model
    joint = reading.legs["FL"].chain.thigh
    return int(model.body_rootid[model.jnt_bodyid[joint]])


def _draw(reading: Reading, random: np.random.Generator) -> Floats:
    ends = [end for leg in reading.robot.legs for end in (leg.limits.thigh, leg.limits.calf)]
    low, high = np.array(ends).T
    drawn: Floats = random.uniform(low, high)
    return drawn
