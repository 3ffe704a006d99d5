"""The certificate of a plan that asks for tolerance: its checks over the whole set of terrains.

Wheels stand on the ground as it is, the trunk keeps its pitch and follows the ground under the
wheels by the load they carry, the legs reach for the ground (native/src/control/leg_fit.cpp). What
the parts of the robot sweep over all terrains of the set is bounded from outside, for every sample
of the motion; docs/method.md has the argument.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import numpy as np
import shapely
from numpy.typing import NDArray

from stairwright.arrays import Floats, Ints
from stairwright.planning.certificate.motion import LEGS_GAP, Motion, Samples, sampled
from stairwright.planning.certificate.tolerance.ground import Geometry
from stairwright.planning.certificate.tolerance.holding import Holding
from stairwright.planning.certificate.tolerance.legs import Sweep, VariedLeg
from stairwright.planning.certificate.tolerance.stands import Part, SecondFaces, Stands
from stairwright.planning.plan import Check
from stairwright.planning.tolerance import Tolerance
from stairwright.robot import kinematics as kin

NAMES = {  # of the checks, by what a tolerance may lack
    "trunk": "clearance of the trunk within tolerance",
    "links": "clearance of the links within tolerance",
    "legs": "gap between front and rear leg within tolerance",
    "joints": "slack of the joint limits within tolerance",
    "com": "room for the centre of mass within tolerance",
    "torque": "share of the motors' torque within tolerance",
}
_HALVES = ((-1.0, 0.0), (0.0, 1.0))
PARTS: list[Part] = list(product(_HALVES, _HALVES, ((0.0, 0.5), (0.5, 1.0))))


def tolerance_checks(motion: Motion, tolerance: Tolerance, second: SecondFaces) -> list[Check]:
    """The checks of a motion of two poses or more.

    Args:
        motion: The plan's.
        tolerance: What it shall stand.
        second: How near a second face must be to a wheel for balance to lean on it (n, 2) [m].
    """
    found = ToleranceCheck(sampled(motion), tolerance, second)
    checks = found.checks()
    if found.unsettled.any() and not found.failed:
        checks = ToleranceCheck(sampled(motion, found.unsettled), tolerance, second).checks()
    return checks


class ToleranceCheck:
    """The checks on samples (n) of a motion.

    Attributes:
        unsettled: (poses - 1,) after `checks`: where clearances are positive, and yet not more than
            what the robot moves between samples.
        failed: After `checks`: whether something fails that closer samples cannot settle.
    """

    def __init__(self, samples: Samples, tolerance: Tolerance, second: SecondFaces) -> None:
        self.samples, self.robot = samples, samples.motion.robot
        self.stands = Stands(samples, tolerance, second)
        self.holding = Holding(self.stands, samples.motion.friction - tolerance.friction)
        self.unsettled = np.zeros(int(samples.interval.max(initial=-1)) + 1, np.bool_)
        self.failed = False

    def checks(self) -> list[Check]:
        """All checks in the order of a reader's interest."""
        slack = self.samples.slack
        out = [
            self._clear("trunk", self._trunk(), slack),
            self._clear("links", self._links(), 2 * slack),  # knees move more than hips and wheels
            self._clear("legs", self._between_legs(), 2 * slack, LEGS_GAP),
            self._least("joints", self._joint_slack(), 0.0, "rad"),
            self._least("com", self.holding.com_margin(), 0.0, "m"),
        ]
        torque = self._least("torque", -self.holding.torques(), -1.0, "1")
        return [*out, torque.model_copy(update={"value": -torque.value, "bound": 1.0})]

    def _joint_slack(self) -> Floats:
        legs = self.stands.legs(np.arange(len(self.samples.slack)))
        slack: Floats = np.min([leg.slack for leg in legs], axis=0)
        return slack

    def _trunk(self) -> Floats:
        body = self.samples.motion.body
        least = np.full(len(body), np.inf)
        for piece in self.robot.body.outline:
            corners = body[:, None, :2] + kin.rotate(body[:, 2, None], np.array(piece.points))
            hulls = shapely.convex_hull(shapely.linestrings(corners))
            for index, ground in self.stands.of_trunk:
                least[index] = np.minimum(least[index], shapely.distance(ground, hulls[index]))
        return least

    def _links(self) -> Floats:
        return self._bounded(self._link_clearance, 2 * self.samples.slack, 0.0)

    def _link_clearance(self, legs: list[VariedLeg], index: Ints) -> Floats:
        """Bounds (k,): of what is near the wheel as seen from there, else from the trunk."""
        from_wheel, from_trunk = [], []
        for pair, leg in enumerate(legs):
            of_wheel, of_trunk = self.stands.of_wheel[pair], self.stands.of_trunk
            from_wheel.append(self._clear_of(leg.seen_from_wheel(), index, of_wheel))
            from_trunk.append(self._clear_of(leg.seen_from_trunk(), index, of_trunk))
        both = np.maximum(np.concatenate(from_wheel), np.concatenate(from_trunk))
        least: Floats = both.min(axis=0)
        return least

    def _clear_of(
        self, sweeps: list[Sweep], index: Ints, grounds: list[tuple[Ints, Geometry]]
    ) -> Floats:
        """Clearance (parts, k) of what is swept at samples `index` (k,) from the ground there."""
        out = np.full((len(sweeps), len(index)), np.inf)
        number = np.empty(len(self.samples.slack), np.int64)
        for k, (group, _) in enumerate(grounds):
            number[group] = k
        hulls = [_hulls(sweep) for sweep in sweeps]
        for k in np.unique(number[index]):
            at = np.flatnonzero(number[index] == k)
            for row, sweep, hull in zip(out, sweeps, hulls, strict=True):
                row[at] = shapely.distance(grounds[k][1], hull[at]) - sweep.radius[at]
        return out

    def _bounded(
        self, bound: Callable[[list[VariedLeg], Ints], Floats], slack: Floats, least: float
    ) -> Floats:
        """Values (n,) by a bound over sets of legs; where it is too low, over parts of them."""
        everywhere = np.arange(len(slack))
        out = bound(self.stands.legs(everywhere), everywhere)
        low = np.flatnonzero(out - slack < least)
        if len(low):
            parts = [bound(self.stands.legs(low, part), low) for part in PARTS]
            out[low] = np.maximum(out[low], np.min(parts, axis=0))
        return out

    def _between_legs(self) -> Floats:
        return self._bounded(_gap, 2 * self.samples.slack, LEGS_GAP)

    def _least(self, what: str, values: Floats, bound: float, unit: str) -> Check:
        k = int(np.argmin(values))
        value = float(np.clip(values[k], -1e3, 1e3))
        passed = bool(value >= bound - 1e-9)
        self.failed |= not passed
        return Check(
            name=NAMES[what], value=value, bound=bound, unit=unit, passed=passed,
            progress=float(self.samples.motion.progress[k]),
        )  # fmt: skip

    def _clear(self, what: str, clearances: Floats, slack: Floats, bound: float = 0.0) -> Check:
        interval = self.samples.interval
        unsettled = (clearances - bound < slack) & (clearances > bound)
        self.unsettled[interval[unsettled[:-1] | unsettled[1:]]] = True
        failed = self.failed or bool(np.any(clearances <= bound))
        check = self._least(what, clearances - slack, bound, "m")
        self.failed = failed
        return check


def _gap(legs: list[VariedLeg], _: Ints) -> Floats:
    """Bounds (k,) of the distance between links and wheels of front and rear leg."""
    front, rear = (
        [(_hulls(sweep), sweep.radius) for sweep in (*leg.seen_from_trunk(), leg.rim())]
        for leg in legs
    )
    gaps = [shapely.distance(a, b) - ra - rb for a, ra in front for b, rb in rear]
    least: Floats = np.min(gaps, axis=0)
    return least


def _hulls(sweep: Sweep) -> NDArray[np.object_]:
    hulls: NDArray[np.object_] = shapely.convex_hull(shapely.linestrings(sweep.points))
    return hulls
