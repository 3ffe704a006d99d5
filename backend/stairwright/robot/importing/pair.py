"""The left and the right leg of a pair as one: means, unions and what both can do."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from stairwright.arrays import Floats
from stairwright.errors import InputError
from stairwright.robot.parts import BENT

from .capsules import Disc2, limited, merged
from .links import LinkPart, Measured, Moments, WheelPart, possible
from .motors import Drive
from .report import Notes

_EQUAL_LENGTH = 1e-7  # m
_MOST_UNLIKE = 5e-3  # m between left and right; more is another kind of leg
_EQUAL_SHARE = 1e-3
_MOST_CAPSULES = 16


@dataclass
class Pair:
    """Front or rear legs.

    Attributes:
        hip: (2,) x, z in our frame [m].
        half_track: Distance of the wheels' planes from the middle [m].
        middle: y of the middle between them [m].
    """

    hip: Floats
    half_track: float
    middle: float
    lengths: tuple[float, float]
    thigh: LinkPart
    calf: LinkPart
    wheel: WheelPart
    limits: tuple[tuple[float, float], tuple[float, float]]
    name: str

    @property
    def path(self) -> str:
        """Where a document has what these legs have unlike the others."""
        return "rear." if self.name == "rear" else ""


def pair_of(left: Measured, right: Measured, where: str, notes: Notes) -> Pair:
    """The mean of two legs.

    Raises:
        InputError: If they differ by more than a few millimetres or bend unlike ways.
    """
    hips = [_hip(leg) for leg in (left, right)]
    both = f"{left.name!r} and {right.name!r}"
    _compare(f"hips of the {where} legs", hips[0][[0, 2]], hips[1][[0, 2]], both, notes)
    for k, what in enumerate(("thighs", "calves")):
        a, b = left.side.lengths[k], right.side.lengths[k]
        _compare(f"{where} {what}", np.array([a]), np.array([b]), both, notes)
    tracks = [abs(float(hip[1])) for hip in hips]
    if abs(tracks[0] - tracks[1]) > 1e-4:
        notes.warn(f"{both} are {tracks[0]:.4g} and {tracks[1]:.4g} m from the middle; mean taken")
    lengths = [(a + b) / 2 for a, b in zip(left.side.lengths, right.side.lengths, strict=True)]
    hip = (hips[0] + hips[1]) / 2
    return Pair(
        hip=hip[[0, 2]],
        half_track=sum(tracks) / 2,
        middle=float(hip[1]),
        lengths=(lengths[0], lengths[1]),
        thigh=_link(left.thigh, right.thigh, f"{where} thighs", notes),
        calf=_link(left.calf, right.calf, f"{where} calves", notes),
        wheel=_wheel(left.wheel, right.wheel, where, notes),
        limits=(_limits(left, right, 0, notes), _limits(left, right, 1, notes)),
        name=where,
    )


def _hip(leg: Measured) -> Floats:
    """The point of the thigh's axis in the plane of the wheel, in our frame."""
    own = leg.side.joints[0].copy()
    own[1] = leg.wheel.lateral
    point: Floats = leg.side.axes.T @ own
    return point


def _compare(what: str, a: Floats, b: Floats, who: str, notes: Notes) -> None:
    off = float(np.abs(a - b).max())
    if off > _MOST_UNLIKE:
        raise InputError(
            f"{what} differ by {1e3 * off:.3g} mm left and right ({who}); they must be alike",
            ("file",),
        )
    if off > _EQUAL_LENGTH:
        notes.warn(f"{what} differ by {1e3 * off:.2g} mm left and right; the mean is taken")


def _link(a: LinkPart, b: LinkPart, what: str, notes: Notes) -> LinkPart:
    mass = (a.mass + b.mass) / 2
    com = (a.mass * a.com + b.mass * b.com) / (a.mass + b.mass)
    _shares(what, "masses", a.mass, b.mass, notes)
    if (off := float(np.abs(a.com - b.com).max())) > 1e-4:
        notes.warn(f"{what}: mass centres differ by {1e3 * off:.2g} mm left and right; mean taken")
    capsules = limited(merged([a.capsules, b.capsules]), _MOST_CAPSULES)
    return LinkPart(mass, com, _mean(a.inertia, b.inertia), capsules,
                    _drive(a.drive, b.drive, what, notes))  # fmt: skip


def _wheel(a: WheelPart, b: WheelPart, where: str, notes: Notes) -> WheelPart:
    what = f"{where} wheels"
    _shares(what, "masses", a.mass, b.mass, notes)
    radii = [each.radius for each in (a, b) if each.radius is not None]
    if len(radii) == 2 and abs(radii[0] - radii[1]) > 1e-4:
        notes.warn(f"{what} have radii {radii[0]:.4g} and {radii[1]:.4g} m; mean taken")
    widths = [each.width for each in (a, b) if each.width is not None]
    return WheelPart(
        (a.mass + b.mass) / 2, _mean(a.inertia, b.inertia),
        sum(radii) / len(radii) if radii else None, max(widths) if widths else None,
        max(a.least, b.least), 0.0, _drive(a.drive, b.drive, what, notes),
    )  # fmt: skip


def _mean(a: Moments, b: Moments) -> Moments:
    return possible([(x + y) / 2 for x, y in zip(a, b, strict=True)])


def _drive(a: Drive, b: Drive, what: str, notes: Notes) -> Drive:
    """The weaker motor of the two."""
    return Drive(
        _weaker(a.torque, b.torque, what, "torques", notes),
        _weaker(a.speed, b.speed, what, "speeds", notes),
        (a.armature + b.armature) / 2,
        (a.damping + b.damping) / 2,
        (a.friction + b.friction) / 2,
    )


def _weaker(a: float | None, b: float | None, what: str, of: str, notes: Notes) -> float | None:
    known = [value for value in (a, b) if value is not None]
    if len(known) == 2:
        _shares(f"{what}' motors", of, known[0], known[1], notes, "the smaller")
    return min(known) if known else None


def _shares(what: str, of: str, a: float, b: float, notes: Notes, which: str = "the mean") -> None:
    if abs(a - b) > _EQUAL_SHARE * max(abs(a), abs(b)):
        notes.warn(f"{what}: {of} differ left and right ({a:.4g}, {b:.4g}); {which} taken")


def _limits(left: Measured, right: Measured, k: int, notes: Notes) -> tuple[float, float]:
    """The range that both joints have."""
    (a, b), (c, d) = left.side.ranges[k], right.side.ranges[k]
    low, high = max(a, c), min(b, d)
    names = f"{left.side.maps[k].name!r} and {right.side.maps[k].name!r}"
    if low >= high:
        raise InputError(f"{names} have no angle in common: they bend unlike ways", ("file",))
    if k == 1 and -BENT <= low < 0.0 < high <= BENT:
        raise InputError(f"{names} bend by no more than {BENT:g} rad: a knee must", ("file",))
    if max(abs(a - c), abs(b - d)) > 1e-3:
        notes.warn(
            f"{names} range over {a:.4g}..{b:.4g} and {c:.4g}..{d:.4g} rad; what both have taken"
        )
    return low, high


def straight(capsules: list[Disc2], length: float) -> bool:
    """Whether they are the one capsule from joint to joint that a link has by itself."""
    return (
        len(capsules) == 1
        and float(np.abs(capsules[0].start).max()) < 1e-9
        and math.dist(capsules[0].end, (0.0, -length)) < 1e-9
    )


def link_document(part: LinkPart, length: float) -> dict[str, Any]:
    """As in a robot's document."""
    made: dict[str, Any] = {
        "length": length,
        "radius": max(capsule.radius for capsule in part.capsules)
        if part.capsules
        else 0.04 * length,
        "mass": part.mass,
        "com": tuple(tidy(value) for value in part.com),
        "inertia": part.inertia,
    }
    if not straight(part.capsules, length):
        made["shape"] = [
            {
                "start": tuple(tidy(value) for value in capsule.start),
                "end": tuple(tidy(value) for value in capsule.end),
                "radius": capsule.radius,
            }
            for capsule in part.capsules
        ]
    return made


def tidy(value: float) -> float:
    """Without the noise of the last digits about zero."""
    return 0.0 if abs(value) < 1e-12 else float(value)
