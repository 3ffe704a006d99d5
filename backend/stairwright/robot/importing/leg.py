"""One leg in the side view: lengths, and how its joints count against ours."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from stairwright.arrays import Floats
from stairwright.errors import InputError

from .frame import Frame
from .report import JointMap, Notes
from .source import Source
from .tree import Chain

_MOST_LEAN = 0.16  # rad of the thigh's axis against the trunk's y
_LIMIT = 4 * math.pi - 1e-6  # rad, of a robot's document
_SHORTEST = 1e-3  # m


@dataclass(frozen=True)
class SideLeg:
    """A leg as seen from the side.

    Attributes:
        chain: Its joints in the file.
        axes: (3, 3) rows in our frame: forward and upward in the leg's plane's x and z, and the
            thigh's axis between them.
        hip: (3,) of the thigh's axis in our frame, at the wheel's plane [m].
        joints: (3, 3) hip, knee and wheel centre in the leg's axes at the reference [m].
        lengths: Thigh and calf [m].
        angles: Absolute angles of thigh and calf at the reference [rad].
        maps: Of thigh, calf and wheel.
        ranges: Of thigh and calf in our angles [rad].
    """

    chain: Chain
    axes: Floats
    hip: Floats
    joints: Floats
    lengths: tuple[float, float]
    angles: tuple[float, float]
    maps: tuple[JointMap, JointMap, JointMap]
    ranges: tuple[tuple[float, float], tuple[float, float]]

    def side(self, points: Floats, link: int) -> Floats:
        """(..., 2) x, z of points in our frame (..., 3), in the frame of link 0, 1 or the wheel."""
        own = (np.asarray(points) @ self.axes.T)[..., [0, 2]] - self.joints[link][[0, 2]]
        angle = self.angles[min(link, 1)]
        c, s = math.cos(angle), math.sin(angle)
        x, z = own[..., 0], own[..., 1]
        turned: Floats = np.stack([c * x - s * z, s * x + c * z], axis=-1)
        return turned


def side_leg(source: Source, frame: Frame, chain: Chain, notes: Notes) -> SideLeg:
    """The leg of `chain`, whose abduction stands where it is held.

    Raises:
        InputError: If its plane is not the side view's, or a link has no length.
    """
    data = source.data
    axis = frame.turn(data.xaxis[chain.thigh])
    axis = axis * math.copysign(1.0, axis[1])
    lean = math.atan2(float(np.hypot(axis[0], axis[2])), float(axis[1]))
    if lean > _MOST_LEAN:
        raise InputError(
            f"{source.joint(chain.thigh)!r}: its axis is {math.degrees(lean):.1f} degrees off the "
            "trunk's lateral axis; the leg does not move in the side view",
            ("file",),
        )
    forward = np.cross(axis, [0.0, 0.0, 1.0])
    forward /= np.linalg.norm(forward)
    axes = np.array([forward, axis, np.cross(forward, axis)])
    anchors = frame.place(data.xanchor[[chain.thigh, chain.calf, chain.wheel]])
    joints = anchors @ axes.T
    steps = np.diff(joints[:, [0, 2]], axis=0)
    lengths = np.hypot(*steps.T).tolist()
    for length, joint in zip(lengths, (chain.calf, chain.wheel), strict=True):
        if length < _SHORTEST:
            raise InputError(
                f"{source.joint(joint)!r} lies on the axis of the joint before it", ("file",)
            )
    angles = [math.atan2(-x, -z) for x, z in steps]
    bend = _wrapped(angles[1] - angles[0])
    signs = [
        math.copysign(1.0, float(frame.turn(data.xaxis[joint]) @ axis))
        for joint in (chain.thigh, chain.calf, chain.wheel)
    ]
    maps, ranges = [], []
    for joint, sign, zero in zip(
        (chain.thigh, chain.calf, chain.wheel), signs, (angles[0], bend, 0.0), strict=True
    ):
        offset = _tidy(zero - sign * float(source.model.qpos0[source.model.jnt_qposadr[joint]]))
        if joint != chain.wheel:
            low, high, offset = _range(source, joint, sign, offset, notes)
            ranges.append((low, high))
        maps.append(JointMap(name=source.joint(joint), sign=sign, offset=offset))
    hip = anchors[0].copy()
    return SideLeg(chain, axes, hip, joints, (lengths[0], lengths[1]), (angles[0], angles[1]),
                   (maps[0], maps[1], maps[2]), (ranges[0], ranges[1]))  # fmt: skip


def _range(
    source: Source, joint: int, sign: float, offset: float, notes: Notes
) -> tuple[float, float, float]:
    """A joint's range in our angles, and its offset less whole turns."""
    model, name = source.model, source.joint(joint)
    if not model.jnt_limited[joint]:
        return -2 * math.pi, 2 * math.pi, _wrapped(offset)
    ends = sorted(sign * value + offset for value in model.jnt_range[joint].tolist())
    if ends[0] >= ends[1]:
        raise InputError(f"{name!r}: its range {ends} is empty", ("file",))
    # Angles that differ by whole turns are the same posture: a range is told near 0, or where it
    # holds every posture the zero is.
    whole = ends[1] - ends[0] >= 2 * math.pi
    turns = 2 * math.pi * round((offset if whole else sum(ends) / 2) / (2 * math.pi))
    low, high = (_tidy(end - turns) for end in ends)
    if max(-low, high) > _LIMIT:
        notes.warn(f"{name!r}: its range {low:.4g}..{high:.4g} rad looks like a slip; cut to two "
                   "turns each way")  # fmt: skip
    elif max(-low, high) > 2 * math.pi:
        notes.warn(f"{name!r}: its range {low:.4g}..{high:.4g} rad exceeds a whole turn each way")
    low, high = max(low, -_LIMIT), min(high, _LIMIT)
    return low, high, _tidy(offset - turns)


def _wrapped(angle: float) -> float:
    return _tidy(math.remainder(angle, 2 * math.pi))


def _tidy(value: float) -> float:
    """Without the last digits' noise about zero."""
    return 0.0 if abs(value) < 1e-12 else value
