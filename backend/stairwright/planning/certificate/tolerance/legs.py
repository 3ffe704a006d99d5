"""Where a leg may be when wheel and hip are not where they were planned relative to each other.

All by intervals: a box of displacements of the wheel from the hip bounds the bearing and the length
of the line between them, these the angles of both links, and these what the links sweep.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from stairwright.arrays import Floats, Ints
from stairwright.planning.certificate.motion import Samples
from stairwright.planning.certificate.tolerance.ground import BOX
from stairwright.robot import kinematics as kin
from stairwright.robot.legs import Capsule, Leg, LinkForm

_PIECES = 3  # of a capsule


@dataclass(frozen=True)
class Sweep:
    """What a capsule sweeps: within `radius` (n,) [m] of the hull of points (n, k, 2)."""

    points: Floats
    radius: Floats


class VariedLeg:
    """A front or rear leg at samples (n), its wheel displaced against its hip.

    Attributes:
        leg: Which one.
        off: (n, 4, 2) corners of the box of displacements, x and z [m].
        thigh, calf: (n, 2) least and largest turn of the links from where they were planned [rad].
        slack: (n,) least slack of the joint limits [rad]; negative, too, out of reach.
    """

    def __init__(self, samples: Samples, index: Ints, pair: int, low: Floats, high: Floats) -> None:
        """Of the samples `index`, displaced by something between `low` and `high` (n, 2) [m]."""
        motion = samples.motion
        self.leg: Leg = motion.robot.legs[pair]
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        self.off = middle[:, None] + half[:, None] * BOX
        self.hip, self.wheel = (
            p[index, pair] for p in (samples.frames.hips, samples.frames.wheels)
        )
        q = motion.joints[index, 2 * pair : 2 * pair + 2]
        self.thigh_angle = motion.body[index, 2] + q[:, 0]
        self.calf_angle = self.thigh_angle + q[:, 1]
        line = self.wheel - self.hip
        corners = line[:, None] + self.off
        bearing = _bearing(corners) - _bearing(line)[:, None]
        bearing = (bearing + np.pi) % (2 * np.pi) - np.pi
        most = np.linalg.norm(corners, axis=2).max(axis=1)
        least = np.linalg.norm(np.maximum(np.abs(line + middle) - half, 0.0), axis=1)
        upper, lower = self.leg.thigh.length, self.leg.calf.length
        open_, bent = self._bend(most), self._bend(least)  # of the calf joint, without sign
        now = np.abs(q[:, 1])
        knee = self.leg.knee
        # The thigh is the bearing less the triangle's angle at the hip, the calf plus that at the
        # wheel.
        low, high = bearing.min(axis=1), bearing.max(axis=1)
        self.thigh = _sum(low, high, -knee, _span(lower, upper, open_, now, bent))
        self.calf = _sum(low, high, knee, _span(upper, lower, open_, now, bent))
        around = np.all(np.abs(line + middle) <= half, axis=1)  # anywhere round the hip
        self.thigh[around], self.calf[around] = (-np.pi, np.pi), (-np.pi, np.pi)
        self.slack = self._slack(q, np.sort(knee * np.stack([open_, bent], axis=1)), most)

    def _bend(self, length: Floats) -> Floats:
        """Angle (n,) of the calf joint at some distances of hip and wheel, without sign [rad]."""
        a, b = self.leg.thigh.length, self.leg.calf.length
        return np.arccos(np.clip((length**2 - a * a - b * b) / (2 * a * b), -1.0, 1.0))

    def _slack(self, q: Floats, calf: Floats, most: Floats) -> Floats:
        limits = self.leg.limits
        a, b = limits.thigh, limits.calf
        slack = np.min(
            [
                q[:, 0] + self.thigh[:, 0] - a[0], a[1] - q[:, 0] - self.thigh[:, 1],
                calf[:, 0] - b[0], b[1] - calf[:, 1],
            ],
            axis=0,
        )  # fmt: skip
        beyond = most - self.leg.reach
        out: Floats = np.where(beyond > 0.0, np.minimum(slack, -beyond / self.leg.reach), slack)
        return out

    def seen_from_wheel(self) -> list[Sweep]:
        """Pieces of thigh and calf with the wheel where it was planned, the hip displaced."""
        return self._thighs(self.hip[:, None] - self.off) + self._calves(self.wheel[:, None])

    def seen_from_trunk(self) -> list[Sweep]:
        """The same pieces with the hip where it was planned, the wheel displaced."""
        return self._thighs(self.hip[:, None]) + self._calves(self.wheel[:, None] + self.off)

    def rim(self) -> Sweep:
        """The wheel, seen from the trunk."""
        return Sweep(
            self.wheel[:, None] + self.off, np.full(len(self.wheel), self.leg.wheel.radius)
        )

    def _thighs(self, hips: Floats) -> list[Sweep]:
        return _swept(self.leg.thigh, self.thigh_angle, self.thigh, hips, 0.0)

    def _calves(self, wheels: Floats) -> list[Sweep]:
        return _swept(self.leg.calf, self.calf_angle, self.calf, wheels, self.leg.calf.length)


def _swept(
    link: LinkForm, angle: Floats, turn: Floats, pivots: Floats, below: float
) -> list[Sweep]:
    """What the pieces of a link sweep that turns about any of `pivots` (n, k, 2).

    Args:
        link: Its capsules are given in its own frame.
        angle: (n,) of the link as planned [rad].
        turn: (n, 2) least and largest turn from there [rad].
        pivots: Where the joint may be that lies `below` the frame's origin, along the link [m].
        below: See `pivots`.
    """
    out = []
    half = 0.5 * (turn[:, 1] - turn[:, 0])
    for start, end, radius in _pieces(link):
        points, farthest = [], 0.0
        for x, z in (start, end):
            arm = np.array([x, z + below])
            farthest = max(farthest, float(np.hypot(*arm)))
            for side in range(2):
                down = kin.along(angle + turn[:, side])
                ahead = np.stack([-down[:, 1], down[:, 0]], axis=1)
                points.append(pivots + (arm[0] * ahead - arm[1] * down)[:, None])
        # An arc rises over its chord by that much.
        rise = farthest * (1.0 - np.cos(np.minimum(half, np.pi)))
        out.append(Sweep(np.concatenate(points, axis=1), radius + rise))
    return out


def _pieces(link: LinkForm) -> Iterator[Capsule]:
    """A link's capsules, cut: what is near to a joint moves less than what is far from it."""
    for start, end, radius in link.capsules:
        cuts = np.linspace(start, end, _PIECES + 1).tolist()
        for a, b in pairwise(cuts):
            yield tuple(a), tuple(b), radius


def _bearing(line: Floats) -> Floats:
    """Absolute angle (...) of lines (..., 2): zero straight down, positive swings backward."""
    angle: Floats = np.arctan2(-line[..., 0], -line[..., 1])
    return angle


def _opposite(bend: Floats, far: float, near: float) -> Floats:
    """Angle of the triangle hip, knee, wheel at the end of the link `near`, without sign [rad]."""
    angle: Floats = np.arctan2(far * np.sin(bend), near + far * np.cos(bend))
    return angle


def _span(far: float, near: float, open_: Floats, now: Floats, bent: Floats) -> Floats:
    """Range (n, 2) of the angle at the link `near` over all bends between two, less what it is."""
    a, b = _opposite(open_, far, near), _opposite(bent, far, near)
    low, high = np.minimum(a, b), np.maximum(a, b)
    if far < near:  # it is largest where the far link stands upright on the line
        top = float(np.arccos(-far / near))
        high = np.where((open_ < top) & (top < bent), np.arcsin(far / near), high)
    at = _opposite(now, far, near)
    return np.stack([low - at, high - at], axis=1)


def _sum(low: Floats, high: Floats, sign: float, span: Floats) -> Floats:
    """Range (n, 2) of a bearing plus or less an angle."""
    first, last = (span[:, 0], span[:, 1]) if sign > 0 else (-span[:, 1], -span[:, 0])
    return np.stack([low + first, high + last], axis=1)
