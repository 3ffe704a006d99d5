"""What the certificate judges: poses on a profile, and samples of the motion between them.

Between poses trunk and joints move linearly. Samples lie so close together that no point of the
robot moves more than `_STRIDE` from one to the next.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from stairwright import _core
from stairwright.arrays import Flags, Floats, Ints
from stairwright.planning.certificate.shape import shape_of
from stairwright.planning.plan import Plan
from stairwright.robot.description import Robot
from stairwright.robot.kinematics import Frames

LEGS_GAP = 0.005  # m, least between front and rear leg
_STRIDE = 0.006  # m
_CLOSER = 8  # times more samples where those do not settle it


@dataclass(frozen=True)
class Motion:
    """Poses along a profile; SI units, world frame.

    Attributes:
        vertices: (m, 2) profile.
        robot: Who moves.
        friction: Between wheels and profile.
        body: (n, 3) trunk: x, z, pitch.
        joints: (n, 4) front thigh, front calf, rear thigh, rear calf.
        progress: (n,) along the way.
    """

    vertices: Floats
    robot: Robot
    friction: float
    body: Floats
    joints: Floats
    progress: Floats

    @classmethod
    def of(cls, plan: Plan) -> Motion:
        """The motion of a plan that has poses."""
        return cls(
            plan.terrain.vertices, plan.robot_description, plan.friction,
            np.array([(p.x_c, p.z_c, p.pitch) for p in plan.poses]),
            np.array([p.q for p in plan.poses]),
            np.array([p.progress for p in plan.poses]),
        )  # fmt: skip

    @property
    def postures(self) -> _core.CertificatePostures:
        """Its poses."""
        return _core.CertificatePostures(shape_of(self.robot), self.body, self.joints)


class Samples:
    """Samples (n) of a motion: its poses alone, unless more is said.

    Attributes:
        motion: With a pose for each sample.
        slack: (n,) the most that a point of the robot moves halfway to the next samples [m].
        interval: (n - 1,) between which poses the motion after a sample lies.
        at_pose: (n,) which of them are poses.
        postures: Tell distances.
        frames: Hips, knees and wheels.
        com: (n, 2) centre of mass [m].
    """

    def __init__(
        self, motion: Motion, slack: Floats | None = None, interval: Ints | None = None
    ) -> None:
        n = len(motion.body)
        self.motion = motion
        self.slack = np.zeros(n) if slack is None else slack
        self.interval = np.arange(n - 1) if interval is None else interval
        self.at_pose = np.append(np.diff(self.interval, prepend=-1) > 0, True)
        self.postures = motion.postures
        self.frames = Frames(*self.postures.joints().swapaxes(0, 1))
        self.com = self.postures.com()


def sampled(motion: Motion, closer: Flags | None = None) -> Samples:
    """Samples of a motion of two poses or more; more of them where `closer` (poses - 1,)."""
    stride = np.diff(motion.postures.way())
    parts = np.maximum(1, np.ceil(stride / _STRIDE)).astype(int)
    if closer is not None:
        parts *= np.where(closer, _CLOSER, 1)
    apart = np.repeat(stride / parts, parts)
    slack = 0.5 * np.maximum(np.append(apart, 0.0), np.append(0.0, apart))
    interval = np.repeat(np.arange(len(parts)), parts)
    first = np.cumsum(parts) - parts
    share = (np.arange(parts.sum()) - np.repeat(first, parts)) / np.repeat(parts, parts)

    poses = np.column_stack([motion.body, motion.joints, motion.progress])
    steps = np.diff(poses, axis=0)
    values = np.vstack([poses[interval] + share[:, None] * steps[interval], poses[-1:]])
    dense = replace(motion, body=values[:, :3], joints=values[:, 3:7], progress=values[:, 7])
    return Samples(dense, slack, interval)
