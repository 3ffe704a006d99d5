"""Whether contacts and motors hold a robot that stands on ground which may be off."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from stairwright._core import GRAVITY
from stairwright.arrays import Floats
from stairwright.planning.certificate.tolerance.balance import Contacts, Pushes
from stairwright.planning.certificate.tolerance.ground import BOX
from stairwright.planning.certificate.tolerance.stands import Stands
from stairwright.robot import kinematics as kin

_CURVED = 1.1  # of the largest shift at the corners of a box: inside it may be a little larger


class Holding:
    """Forces at the samples (n) of `stands`, with the least friction there may be."""

    def __init__(self, stands: Stands, friction: float) -> None:
        self.stands, self.samples, self.robot = stands, stands.samples, stands.robot
        self.firm: Contacts = stands.contacts(friction)

    @cached_property
    def _corners(self) -> list[tuple[Floats, Floats]]:
        """Wheels (n, 2, 2) displaced against the trunk, and the joints (n, 4) that this takes.

        At the corners of what is possible; NaN out of reach.
        """
        x, z, pitch = self.samples.motion.body.T
        wheels = self.samples.frames.wheels
        out = []
        for share in self.stands.shares.T:
            for corner in BOX:
                apart = self.stands.apart * corner
                moved = np.stack([(1.0 - share)[:, None] * apart, -share[:, None] * apart], axis=1)
                there = wheels + moved
                out.append((there, kin.inverse(self.robot, x, z, pitch, there)))
        return out

    @cached_property
    def _com_shift(self) -> Floats:
        """(n,) how far the mass centre may move along x against the trunk [m]."""
        x, z, pitch = self.samples.motion.body.T
        shifts = []
        for _, joints in self._corners:
            frames = kin.forward(self.robot, x, z, pitch, joints)
            com = kin.com(self.robot, x, z, pitch, frames)
            shifts.append(np.abs(com[:, 0] - self.samples.com[:, 0]))
        most: Floats = _CURVED * np.nan_to_num(np.max(shifts, axis=0), nan=np.inf)
        return most

    @cached_property
    def _sides(self) -> tuple[Pushes, Floats, Floats]:
        """Pushes, and by how much their moments are above and below zero on all terrains [m]."""
        pushes = Pushes.of(self.firm)
        lost = pushes.lost(self.stands.apart, self.stands.shares, self._com_shift)
        above = np.where(np.isnan(pushes.moment), -np.inf, pushes.moment - lost)
        below = np.where(np.isnan(pushes.moment), -np.inf, -pushes.moment - lost)
        return pushes, above, below

    def com_margin(self) -> Floats:
        """Of the mass centre (n,) to where balance ends on some terrain [m]."""
        _, above, below = self._sides
        margin: Floats = np.minimum(above.max(axis=1), below.max(axis=1))
        return margin

    def torques(self) -> Floats:
        """Largest static torque (n,) as a share of its motor's; infinite where nothing holds."""
        pushes, above, below = self._sides
        size = np.linalg.norm(self.firm.rays[..., :2], axis=2)
        effort = (pushes.factors * size[:, pushes.pairs]).sum(axis=2)
        high = np.argmin(np.where(above >= 0.0, effort, np.inf), axis=1)
        low = np.argmin(np.where(below >= 0.0, effort, np.inf), axis=1)
        rows = np.arange(len(high))
        lost = pushes.lost(self.stands.apart, self.stands.shares, self._com_shift)
        up, down = pushes.moment[rows, high], pushes.moment[rows, low]
        wide = {
            side: (up + side * lost[rows, high], down + side * lost[rows, low]) for side in (-1, 1)
        }
        with np.errstate(invalid="ignore"):  # moments are infinite where nothing holds
            mixtures = [np.clip(-d / np.maximum(u - d, 1e-9), 0.0, 1.0) for u, d in wide.values()]
        one = pushes.forces(self.firm.rays, high)
        other = pushes.forces(self.firm.rays, low)
        worst = np.zeros(len(rows))
        for mixture in mixtures:
            forces = mixture[:, None, None] * one + (1.0 - mixture)[:, None, None] * other
            for wheels, joints in self._corners:
                worst = np.maximum(worst, self._torque_share(forces, wheels, joints))
        worst = np.where(self.com_margin() >= 0.0, np.nan_to_num(worst, nan=np.inf), np.inf)
        return worst

    def _torque_share(self, forces: Floats, wheels: Floats, joints: Floats) -> Floats:
        """Largest static torque (n,) as a share of its motor's, with `forces` (n, m, 2) on rays."""
        robot, contacts = self.robot, self.firm
        x, z, pitch = self.samples.motion.body.T
        weight = robot.mass * GRAVITY
        frames = kin.forward(robot, x, z, pitch, joints)
        shares = []
        for pair, leg in enumerate(robot.legs):
            of_pair = contacts.front == (pair == 0)
            push = 0.5 * weight * forces[:, of_pair]
            moved = wheels[:, pair] - self.samples.frames.wheels[:, pair]
            at = contacts.points[:, of_pair] + moved[:, None]
            hip, knee, wheel = frames.hips[:, pair], frames.knees[:, pair], wheels[:, pair]
            thigh, calf = kin.link_com(leg.thigh, hip, knee), kin.link_com(leg.calf, knee, wheel)
            parts = ((leg.thigh.mass, thigh), (leg.calf.mass, calf), (leg.wheel.mass, wheel))
            for joint, carried, motor in zip(
                (hip, knee, wheel), (parts, parts[1:], ()), leg.motors, strict=True
            ):
                arm = at - joint[:, None]
                torque = (arm[..., 0] * push[..., 1] - arm[..., 1] * push[..., 0]).sum(axis=1)
                for mass, centre in carried:
                    torque = torque - GRAVITY * mass * (centre[:, 0] - joint[:, 0])
                shares.append(np.abs(torque) / motor.torque)
        largest: Floats = np.max(shares, axis=0)
        return largest
