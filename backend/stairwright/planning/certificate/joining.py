"""The exact check of the motion that joins sparse poses, and what stops it where it fails."""

from __future__ import annotations

import numpy as np

from stairwright import _core
from stairwright.planning.certificate.certify import judge
from stairwright.planning.certificate.motion import Motion
from stairwright.planning.plan import Certificate, Check, Plan
from stairwright.planning.poses.interpolation import reference
from stairwright.planning.poses.pose_reference import Reference
from stairwright.planning.problem import Problem, ProblemKind, between_poses
from stairwright.planning.static_torques import static_torques
from stairwright.terrain.wheel_path import wheel_path

# Room for the centre of mass: of 490 random stairs climbed with more every rollout succeeds, of
# those with less none does.
STEADY = 0.008  # m

# What a failed check of the certificate says, the gravest first.
_STOPS: dict[str, tuple[ProblemKind, str]] = {
    "samples out of balance": ("statics", "the robot loses its balance"),
    "largest joint step": ("reach", "joints would have to jump"),
    "slack of the joint limits": ("joint_limit", "a joint would have to pass its limit"),
    "clearance of the trunk": ("clearance", "the trunk comes too close to the terrain"),
    "clearance of the links": ("clearance", "a leg comes too close to the terrain"),
    "gap between front and rear leg": ("clearance", "the legs come too close to each other"),
    "gap between wheels and ground": ("reach", "a wheel would leave the ground"),
    "wheels sunk into the ground": ("reach", "a wheel would sink into the ground"),
}


def certify_motion(plan: Plan) -> Certificate:
    """The exact check of the motion that is tracked between a plan's poses: `reference(plan)`.

    Plans of sparse poses certify these only (``certificate.scope`` is ``poses``); this says what
    `certificate` says of the dense trajectory that joins them, sample by sample.
    """
    return _certify(plan, reference(plan))


def motion_problem(plan: Plan) -> Problem | None:
    """What stops the motion that is tracked between the poses of `plan`, if anything."""
    samples = reference(plan)
    failed = {check.name: check for check in _certify(plan, samples).checks if not check.passed}
    for name in _STOPS:
        if name in failed:
            return _problem(failed[name], plan, samples)
    return _overload(plan, samples) or _thin_balance(plan, samples)


def _overload(plan: Plan, samples: Reference) -> Problem | None:
    """Where standing still takes most of what a motor can give, if that is more than all."""
    robot, q = plan.robot_description, samples.q
    torques = static_torques(robot, samples.trunk, q, samples.contacts, samples.forces)
    pairs = np.abs(torques.reshape(-1, 4, 3))[:, [0, 2]]  # left legs, the right ones are as they
    shares = pairs / robot.torque_limits
    i, pair, joint = np.unravel_index(int(np.argmax(shares)), shares.shape)
    if shares[i, pair, joint] <= 1.0:
        return None
    motor = f"{('front', 'rear')[pair]} {('thigh', 'calf', 'wheel')[joint]} motors"
    much = f"{pairs[i, pair, joint]:.3g} Nm, {robot.torque_limits[pair, joint]:.3g} Nm is all"
    return _stopped("torque", f"the {motor} would have to hold {much}", plan, samples, int(i))


def _thin_balance(plan: Plan, samples: Reference) -> Problem | None:
    """Where the centre of mass has least room along the motion, if that is too little."""
    path = wheel_path(plan.terrain, plan.robot_description.wheel.radius)
    low, high = _core.com_intervals(path.native, samples.wheel_progress, plan.friction).T
    room = np.minimum(samples.com[:, 0] - low, high - samples.com[:, 0])
    i = int(np.argmin(room))
    if room[i] >= STEADY:
        return None
    what = f"the centre of mass keeps {room[i] * 1e3:.0f} mm from where balance ends"
    return _stopped("statics", f"{what}, {STEADY * 1e3:.0f} mm are safe", plan, samples, i)


def _certify(plan: Plan, samples: Reference) -> Certificate:
    robot, ground = plan.robot_description, plan.terrain.vertices
    return judge(Motion(ground, robot, plan.friction, samples.trunk, samples.q, samples.progress))


def _problem(check: Check, plan: Plan, samples: Reference) -> Problem:
    kind, what = _STOPS[check.name]
    much = f" ({check.value:.2g} {check.unit}, bound {check.bound:g})" if check.unit != "1" else ""
    i = int(np.searchsorted(samples.progress, check.progress or 0.0))
    return _stopped(kind, what + much, plan, samples, min(i, len(samples.progress) - 1))


def _stopped(kind: ProblemKind, what: str, plan: Plan, samples: Reference, i: int) -> Problem:
    x, z = samples.contacts[i, 0].tolist()
    progress = float(samples.progress[i])
    before = sum(pose.progress <= progress for pose in plan.poses[:-1])
    return between_poses(kind, (x, z), progress, before, what)
