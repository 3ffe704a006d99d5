"""The certificate: an independent, exact check of a plan, poses and the motion between.

It shares no geometry or statics with the planner: what takes time is native, in a module of its own
(native/src/certificate), which tests compare with shapely and linear programmes. Clearances count
less half of what the robot moves between two samples of the motion: what is certified holds in
between too. Where that is too little to tell, samples lie closer still.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from typing import Any, Literal, get_args

import numpy as np

from stairwright import _core
from stairwright.arguments import as_model
from stairwright.arrays import Floats
from stairwright.errors import InputError
from stairwright.planning.certificate.dynamics import Dynamics, dynamics_of
from stairwright.planning.certificate.equilibrium import TOUCH, WHEEL_GAP, balanced, near_faces
from stairwright.planning.certificate.motion import LEGS_GAP, Motion, Samples, sampled
from stairwright.planning.certificate.tolerance.checks import tolerance_checks
from stairwright.planning.plan import Certificate, Check, Plan
from stairwright.planning.tolerance import Tolerance
from stairwright.robot import kinematics as kin

WHEEL_SINK = 0.001  # m
TRUNK_CLEARANCE, LINKS_CLEARANCE = "clearance of the trunk", "clearance of the links"
ROOM = 0.002  # m; clearances are told that exactly where they are not certainly larger
_JOINT_STEP = 0.35  # rad between two poses

Scope = Literal["motion", "poses"]


def certify(plan: Plan | Mapping[str, Any], scope: Scope | None = None) -> Certificate:
    """Check `plan` against terrain, robot and friction that it names.

    Args:
        plan: Any plan with poses, or its document.
        scope: ``motion`` checks the motion between poses too, ``poses`` only the poses; by default
            the motion for dense paths and the poses for the others.

    Raises:
        InputError: If an argument is bad.
    """
    plan = as_model(Plan, plan, "plan")
    if scope not in (None, *get_args(Scope)):
        raise InputError(f"must be one of: {', '.join(get_args(Scope))}", ("scope",))
    chosen: Scope = scope or ("motion" if plan.method == "path" else "poses")
    if not plan.poses:
        missing = Check(name="poses", value=0.0, bound=1.0, unit="1", passed=False)
        return Certificate(passed=False, scope=chosen, checks=[missing])
    motion = Motion.of(plan)
    found = judge(motion, chosen)
    if plan.tolerance is not None and len(plan.poses) > 1:
        found = found.with_checks(tolerated(motion, plan.tolerance))
    return with_dynamics(found, plan) if plan.timing.rule == "fast" else found


def with_dynamics(
    certificate: Certificate, plan: Plan, known: Dynamics | None = None
) -> Certificate:
    """`certificate` with the checks of a plan that moves fast; its dynamics may be `known`."""
    least = float(np.diff([pose.time for pose in plan.poses]).min(initial=np.inf))
    checks = [
        Check(name="least step of time", value=least, bound=0.0, unit="s", passed=least > 0.0)
    ]
    if checks[0].passed:
        checks += (known or dynamics_of(plan)).checks()
    return certificate.model_copy(
        update={
            "checks": [*certificate.checks, *checks],
            "passed": certificate.passed and all(check.passed for check in checks),
        }
    )


def tolerated(motion: Motion, tolerance: Tolerance) -> list[Check]:
    """What a motion of two poses or more keeps on every terrain within `tolerance`."""
    return tolerance_checks(motion, tolerance, lambda samples: _Checker(samples).second_faces())


def judge(motion: Motion, scope: Scope = "motion") -> Certificate:
    """Check poses, and the motion between them unless `scope` is ``poses``."""
    if scope == "poses" or len(motion.body) < 2:
        checks = _Checker(Samples(motion)).checks()
    else:
        checker = _Checker(sampled(motion))
        checks = checker.checks()
        if checker.unsettled.any():
            checks = _Checker(sampled(motion, checker.unsettled)).checks()
        checks += _order(motion)
    return Certificate(passed=all(c.passed for c in checks), scope=scope, checks=checks)


class _Checker:
    """The checks on samples (n) of a motion.

    Attributes:
        unsettled: (poses - 1,) after `checks`: whether clearances between two poses are positive,
            and yet hardly more than what the robot moves between samples.
    """

    def __init__(self, samples: Samples) -> None:
        self.samples, self.progress = samples, samples.motion.progress
        self.unsettled = np.zeros(int(samples.interval.max(initial=-1)) + 1, np.bool_)
        self.ground = _core.CertificateGround(samples.motion.vertices)
        wheels, radius = samples.frames.wheels, samples.motion.robot.wheel.radius
        self.near = near_faces(self.ground, wheels.reshape(-1, 2), radius + WHEEL_GAP)

    def checks(self) -> list[Check]:
        """All checks in the order of a reader's interest."""
        postures, ground, slack = self.samples.postures, self.ground, self.samples.slack
        rims = [postures.rims(leg, ground) for leg in range(2)]
        return [
            self._most("gap between wheels and ground", np.maximum(*rims), WHEEL_GAP),
            self._most("wheels sunk into the ground", -np.minimum(*rims), WHEEL_SINK),
            self._clear(TRUNK_CLEARANCE, postures.trunk(ground, slack)),
            self._clear(LINKS_CLEARANCE, postures.links(ground, slack)),
            self._least("gap between front and rear leg", postures.between_legs(), LEGS_GAP, "m"),
            self._least("slack of the joint limits", self._limits(), 0.0, "rad"),
            self._balance(),
        ]

    def _least(self, name: str, values: Floats, bound: float, unit: str) -> Check:
        k = int(np.argmin(values))
        value = float(values[k])
        return Check.trusted(
            name=name, value=value, bound=bound, unit=unit, passed=bool(value >= bound - 1e-9),
            progress=float(self.progress[k]),
        )  # fmt: skip

    def _most(self, name: str, values: Floats, bound: float) -> Check:
        k = int(np.argmax(values))
        value = float(values[k])
        return Check.trusted(
            name=name, value=value, bound=bound, unit="m", passed=bool(value <= bound + 1e-9),
            progress=float(self.progress[k]),
        )  # fmt: skip

    def _clear(self, name: str, clearances: Floats) -> Check:
        slack, interval = self.samples.slack, self.samples.interval
        unsettled = (clearances < slack + ROOM) & (clearances > 0.0)
        self.unsettled[interval[unsettled[:-1] | unsettled[1:]]] = True
        return self._least(name, clearances - slack, 0.0, "m")

    def _limits(self) -> Floats:
        """Least distance of the joints from their limits (n,) [rad]."""
        low, high = kin.limits(self.samples.motion.robot).T
        joints = self.samples.motion.joints
        return reduce(np.minimum, (*(joints - low).T, *(high - joints).T))

    def second_faces(self) -> Floats:
        """How near a second face must be to a wheel's centre (n, 2) for balance to lean on it [m].

        Only what is truly touched counts: a wheel nearly in a corner is balanced on the one face
        that it is on. Where it stays in a corner from one pose to the next, interpolated joints
        take it up to a millimetre out of it in between; it touches both faces all the same.
        """
        samples, motion = self.samples, self.samples.motion
        r = motion.robot.wheel.radius
        wheels, ends = samples.frames.wheels, samples.at_pose
        out = np.full(wheels.shape[:2], r + TOUCH)
        if ends.all():
            return out
        wedged = (self.near.distances[:, 1] <= r + TOUCH).reshape(-1, 2)[ends]
        moved = np.linalg.norm(np.diff(wheels[ends], axis=0), axis=2)
        stays = wedged[:-1] & wedged[1:] & (moved <= 2 * TOUCH)
        out[~ends] = np.where(stays[samples.interval[~ends[:-1]]], r + WHEEL_GAP, r + TOUCH)
        return out

    def _balance(self) -> Check:
        """Whether forces inside the friction cones of all touching faces balance the weight."""
        motion = self.samples.motion
        reach, further = motion.robot.wheel.radius + WHEEL_GAP, self.second_faces().ravel()
        touched = self.near.touched(reach, further)
        failed = ~balanced(self.near, touched, self.samples.com[:, 0], motion.friction)
        k = int(np.argmax(failed))
        return Check(
            name="samples out of balance", value=float(failed.sum()), bound=0.0, unit="1",
            passed=not failed.any(), progress=float(self.progress[k]) if failed.any() else None,
        )  # fmt: skip


def _order(motion: Motion) -> list[Check]:
    """Progress rises; joints do not jump between poses."""
    steps = np.diff(motion.progress)
    jumps = np.abs(np.diff(motion.joints, axis=0)).max(axis=1)
    widest = int(np.argmax(jumps))
    return [
        Check(
            name="least step of progress", value=float(steps.min()), bound=0.0, unit="m",
            passed=bool(steps.min() > 0.0),
        ),
        Check(
            name="largest joint step", value=float(jumps[widest]), bound=_JOINT_STEP, unit="rad",
            passed=bool(jumps[widest] <= _JOINT_STEP), progress=float(motion.progress[widest]),
        ),
    ]  # fmt: skip
