"""Where forward, left and up are in a robot's file, and the angle at which its legs stand upright.

Everything that follows is measured in axes of ours (x forward, y left, z up) that are fixed to the
trunk and have their origin where the trunk's body has it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from stairwright.arrays import Floats
from stairwright.errors import InputError

from .holding import note_range
from .report import Notes
from .source import Source
from .tree import Chain, Tree

_STRAIGHT = math.cos(math.radians(10.0))  # how well an axis must fit one of the trunk's
_MOST_TILT = 0.15  # rad from upright


@dataclass(frozen=True)
class Frame:
    """Axes of ours in the world of the model at its reference posture.

    Attributes:
        axes: (3, 3) rows: forward, left, up.
        origin: (3,) of the trunk's body.
    """

    axes: Floats
    origin: Floats

    def place(self, point: Floats) -> Floats:
        """Points (..., 3) of the world in our axes."""
        placed: Floats = (np.asarray(point) - self.origin) @ self.axes.T
        return placed

    def turn(self, vector: Floats) -> Floats:
        """Directions (..., 3) of the world in our axes."""
        turned: Floats = np.asarray(vector) @ self.axes.T
        return turned


def find_frame(source: Source, tree: Tree, notes: Notes) -> Frame:
    """Forward is along the abduction axes, or across the wheels' where legs do not tilt sideways.

    A robot looks along a positive axis of its trunk.

    Raises:
        InputError: If these axes lie along none of the trunk's.
    """
    data = source.data
    body = min(tree.trunk)
    trunk = data.xmat[body].reshape(3, 3).T  # rows: the trunk's axes in the world
    # The hips spread over a rectangle: up is across it, and against gravity where that is clear.
    hips = (data.xanchor[[leg.thigh for leg in tree.legs]] - data.xpos[body]) @ trunk.T
    spread = np.ptp(hips, axis=0)
    first = [leg.abduction for leg in tree.legs if leg.abduction is not None]
    wheels = [leg.wheel for leg in tree.legs]
    tilting = len(first) == len(tree.legs)
    taken = _along(source, trunk, first if tilting else wheels, source.body(body))
    if tilting and taken == int(spread.argmin()):  # they steer
        tilting, taken = False, _along(source, trunk, wheels, source.body(body))
    spread[taken] = np.inf
    up = int(spread.argmin())
    against = float((trunk @ np.array([0.0, 0.0, 1.0]))[up])
    rise = math.copysign(1.0, against) if abs(against) > 0.5 else 1.0
    z, other = rise * np.eye(3)[up], np.eye(3)[taken]
    x = other if tilting else np.cross(other, z)
    x = x * math.copysign(1.0, x.sum())
    y = np.cross(z, x)
    if x[0] != 1.0 or z[2] != 1.0:
        letters = "xyz"
        notes.assume(
            f"{source.body(body)!r} looks along its own {letters[int(np.abs(x).argmax())]} axis, "
            f"up is {'-' if rise < 0 else ''}{letters[up]}"
        )
    return Frame(np.array([x, y, z]) @ trunk, data.xpos[body].copy())


def _along(source: Source, trunk: Floats, joints: list[int], name: str) -> int:
    """Which of the trunk's axes the axes of `joints` lie along."""
    own = [trunk @ source.data.xaxis[joint] for joint in joints]
    mean = np.mean([axis * math.copysign(1.0, axis @ own[0]) for axis in own], axis=0)
    mean /= max(float(np.linalg.norm(mean)), 1e-12)
    index = int(np.abs(mean).argmax())
    if abs(mean[index]) < _STRAIGHT:
        raise InputError(
            f"{source.joint(joints[0])!r} and its kin turn about {np.round(mean, 3).tolist()}, "
            f"along none of the axes of {name!r}",
            ("file",),
        )
    return index


def upright(
    source: Source, tree: Tree, frame: Frame, tilt: float, notes: Notes
) -> dict[int, float]:
    """Positions of the abduction joints at which the legs lean outward by `tilt` [rad].

    Raises:
        InputError: If a leg cannot stand so, or its thigh turns about an axis that does not lie
            across the trunk; names the joint.
    """
    if abs(tilt) > _MOST_TILT:
        raise InputError(
            f"{tilt:g} rad would tilt the legs' planes out of the side view; at most "
            f"{_MOST_TILT:g} rad",
            ("abduction",),
        )
    held = {}
    for leg in tree.legs:
        side = math.copysign(1.0, float(frame.place(source.data.xanchor[leg.wheel])[1]))
        if leg.abduction is None:
            if tilt:
                notes.warn(f"{source.joint(leg.thigh)!r}: the leg has no abduction to lock")
            continue
        held[leg.abduction] = _angle(source, frame, leg, side * tilt)
    _check_ranges(source, held, notes)
    return held


def _angle(source: Source, frame: Frame, leg: Chain, lean: float) -> float:
    """Position of a leg's abduction joint at which its thigh axis is level, plus `lean` about x."""
    assert leg.abduction is not None
    axis = frame.turn(source.data.xaxis[leg.abduction])
    thigh = frame.turn(source.data.xaxis[leg.thigh])
    thigh *= math.copysign(1.0, thigh[1])
    along = float(axis @ thigh)
    if abs(along) > 0.9:
        raise InputError(
            f"{source.joint(leg.abduction)!r} turns about the axis of "
            f"{source.joint(leg.thigh)!r}: one joint too many in the side view; hold one "
            f"in each leg, for instance {source.joint(leg.abduction)}=0 [rad]",
            ("file",),
        )
    # Turning about `axis` by a: thigh_y(a) = c + p cos a + q sin a, at its most where tan a = q/p.
    p = thigh[1] - along * axis[1]
    q = float(np.cross(axis, thigh)[1])
    level = math.atan2(q, p)
    if abs(axis[0]) < 0.7 and lean:
        raise InputError(f"{source.joint(leg.abduction)!r} does not tilt the leg sideways",
                         ("abduction",))  # fmt: skip
    return level + math.copysign(lean, lean * axis[0]) if lean else level


def _check_ranges(source: Source, held: dict[int, float], notes: Notes) -> None:
    model = source.model
    for joint, turn in held.items():
        # `turn` is from the reference; the file counts from its own zero.
        at = turn + float(model.qpos0[model.jnt_qposadr[joint]])
        held[joint] = at if abs(at) > 1e-9 else 0.0
        note_range(source, joint, at, notes)
