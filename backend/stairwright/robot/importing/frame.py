"""Where forward, left and up are in a robot's file, and the angle at which its legs stand upright.

Everything that follows is measured in axes of ours (x forward, y left, z up) that are fixed to the
trunk and have their origin where the trunk's body has it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stairwright.errors import InputError

from .report import Notes
from .source import Source
from .tree import Chain, Tree

Floats = NDArray[np.float64]

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
    """Left is along the wheels' axes, up along the trunk's z, forward its x where that fits.

    Raises:
        InputError: If the wheels' axes lie along no axis of the trunk.
    """
    data = source.data
    body = min(tree.trunk) if tree.trunk else int(source.model.jnt_bodyid[tree.legs[0].joints[0]])
    trunk = data.xmat[body].reshape(3, 3).T  # rows: the trunk's axes in the world
    own = [trunk @ data.xaxis[leg.wheel] for leg in tree.legs]
    aligned = [axis * math.copysign(1.0, axis @ own[0]) for axis in own]
    lateral = np.mean(aligned, axis=0)
    lateral /= max(float(np.linalg.norm(lateral)), 1e-12)
    left = int(np.abs(lateral).argmax())
    if abs(lateral[left]) < _STRAIGHT:
        raise InputError(
            f"the wheels of {source.body(body)!r} turn about {np.round(lateral, 3).tolist()}, "
            "along none of its axes",
            ("file",),
        )
    up = 2 if left != 2 else 1
    gravity = trunk @ np.array([0.0, 0.0, 1.0])
    steepest = int(np.abs(gravity).argmax())
    if left != steepest and abs(gravity[steepest]) > _STRAIGHT:
        up = steepest
    rise = math.copysign(1.0, gravity[up]) if abs(gravity[up]) > 0.5 else 1.0
    z = rise * np.eye(3)[up]
    y = np.eye(3)[left]
    x = np.cross(y, z)
    if x.sum() < 0:  # forward along a positive axis of the trunk
        x, y = -x, -y
    if x[0] != 1.0:
        letters = "xyz"
        notes.assume(
            f"{source.body(body)!r} looks along its own {letters[int(np.abs(x).argmax())]} axis, "
            f"up is {'-' if rise < 0 else ''}{letters[up]}"
        )
    return Frame(np.array([x, y, z]) @ trunk, data.xpos[body].copy())


def upright(source: Source, tree: Tree, frame: Frame, tilt: float, notes: Notes) -> dict[int, float]:
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
            f"{source.joint(leg.thigh)!r}: one joint too many in the side view",
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
        low, high = model.jnt_range[joint]
        at = turn + float(model.qpos0[model.jnt_qposadr[joint]])
        held[joint] = at if abs(at) > 1e-9 else 0.0
        if model.jnt_limited[joint] and not low - 1e-6 <= at <= high + 1e-6:
            notes.warn(
                f"{source.joint(joint)!r} is held at {at:.4g} rad, out of its range "
                f"{low:.4g}..{high:.4g}"
            )
