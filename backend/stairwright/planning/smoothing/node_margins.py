"""What the nodes of a path are worth: joints, margins, forces and torques, as arrays.

The native core computes them (native/include/stairwright/smoothing/node_margins.hpp); the bounds
that a path must keep are here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, Literal

import numpy as np

from stairwright._core import LEAN, LEGS_GAP, LIGHT, LOW, SPARE
from stairwright.arrays import Floats, Ints

Motor = Literal["leg", "wheel"]

LEAST_CLEARANCE = 0.0005  # m, also between nodes; the best controller strays that far
LEAST_COM = 0.001  # m; no robot's centre of mass is known better
# That share of the friction must be left everywhere: rolling up takes more than standing there. By
# its own sensors a robot failed on a third of ramps that leave 1 %, and on all that leave 0.05 %.
LEAST_GRIP = 0.02
# On a slope with less than that left wheels slip a little, always the same way, and a robot that
# knows its place by its wheels is a centimetre off per metre. For each beyond some [m] so much must
# be left [1/m].
STEEP_GRIP, FREE_SLOPE, GRIP_PER_METRE = 0.1, 0.7, 0.05
# Where the CoM has less room than this [m], that share of the friction must be left: else a wheel
# that slides a little tips the robot.
THIN_COM, FIRM_GRIP = 0.006, 0.08
# Where the robot stands on one pair of wheels, that share of the friction must be left: on an edge
# a wheel that is 5 mm off has to hold a few degrees more.
STANDING_GRIP = 0.12
FIRM_TORQUE = 0.9  # of the motors' torques that standing may take: the rest moves and corrects
BEYOND_REPAIR = 0.15  # of a motor's torque; where more is lacking somewhere another path is needed
JOINTS: dict[Motor, slice] = {"leg": slice(0, 2), "wheel": slice(2, 3)}


@dataclass(frozen=True)
class NodeMargins:
    """Arrays over the nodes of a path. SI units.

    Attributes:
        friction: What there is.
        torque_limits: (2, 3) front and rear: of thigh, calf and wheel motors [Nm].
        legs: Length of the front legs [m].
        wheels: (n, 2) places of the pairs on the wheel-centre curve [m].
        q: (n, 4) planar joints.
        com: (n, 2) centre of mass.
        trunk_clearance, link_clearance: (n,) distances from the terrain.
        legs_distance: (n,) of the front from the rear leg.
        joint_slack: (n,) least distance from a joint limit [rad].
        com_margin: (n,) at the friction there is.
        firm_com_margin: (n,) the same with friction on one face of a corner only, which robots can
            hold.
        strayed_com_margin: (n,) the same where a wheel on an edge is 3 mm from its place.
        com_height: (n,) of the CoM above the contacts of the pair that carries more [m].
        friction_needed: (n,).
        forces: (n, 2, 2) force of each wheel pair, tangential and normal [N]; a wheel between two
            faces counts them along the bisector of the faces that carry it.
        torques: (n, 2, 3) static torques of a front and a rear leg: thigh, calf, wheel [Nm].
    """

    friction: float
    torque_limits: Floats
    legs: float
    wheels: Floats
    q: Floats
    com: Floats
    trunk_clearance: Floats
    link_clearance: Floats
    legs_distance: Floats
    joint_slack: Floats
    com_margin: Floats
    firm_com_margin: Floats
    strayed_com_margin: Floats
    com_height: Floats
    friction_needed: Floats
    forces: Floats
    torques: Floats

    def part(self, begin: int, end: int) -> NodeMargins:
        """The margins of the nodes [begin, end)."""
        return replace(self, **{name: getattr(self, name)[begin:end] for name in _OF_NODES})

    @property
    def clearance(self) -> Floats:
        """(n,) least distance of trunk and links from the terrain [m]."""
        return np.minimum(self.trunk_clearance, self.link_clearance)

    def torque_margin(self, motor: Motor) -> Floats:
        """(n,) limit minus static torque of the motors that have least to spare [Nm]."""
        spare = self.torque_limits - np.abs(self.torques)
        least: Floats = spare[:, :, JOINTS[motor]].min(axis=(1, 2))
        return least

    def torque_shares(self, motor: Motor) -> Floats:
        """(n,) largest static torque of such motors, over their limit."""
        shares: Floats = (np.abs(self.torques) / self.torque_limits)[:, :, JOINTS[motor]]
        most: Floats = shares.max(axis=(1, 2))
        return most

    @property
    def _grip_of_slopes(self) -> Floats:
        """(n,) share of the friction that must be left where little is over a long way."""
        steep = self.friction_needed > (1.0 - STEEP_GRIP) * self.friction
        rolled = np.abs(np.diff(self.wheels, axis=0)).mean(axis=1)
        share = np.zeros(len(steep))
        edges = np.flatnonzero(np.diff(steep, prepend=False, append=False))
        for begin, end in edges.reshape(-1, 2):
            beyond = max(rolled[begin : end - 1].sum() - FREE_SLOPE, 0.0)
            share[begin:end] = min(GRIP_PER_METRE * beyond, STEEP_GRIP)
        return share

    @cached_property
    def _slacks(self) -> Floats:
        """(10, n) margins, each against its bound, in comparable sizes."""

        def spare_friction(least: float | Floats) -> Floats:
            return 0.2 * ((1.0 - least) * self.friction - self.friction_needed)

        carried = np.linalg.norm(self.forces, axis=2)
        light = 0.2 * (carried.min(axis=1) / carried.sum(axis=1) - LIGHT)
        lean = self.firm_com_margin - LEAN * (self.com_height - LOW * self.legs).clip(0.0)
        slacks: Floats = np.stack(
            [
                self.clearance - LEAST_CLEARANCE,
                self.legs_distance - LEGS_GAP,
                0.2 * self.joint_slack,
                self.firm_com_margin - LEAST_COM,
                self.strayed_com_margin,
                spare_friction(np.maximum(LEAST_GRIP, self._grip_of_slopes)),
                np.maximum(self.firm_com_margin - THIN_COM, spare_friction(FIRM_GRIP)),
                np.maximum(np.minimum(lean, spare_friction(STANDING_GRIP)), light),
                *(0.3 * (FIRM_TORQUE - self.torque_shares(motor)) for motor in JOINTS),
            ]
        )
        return slacks

    @property
    def least_slack(self) -> Floats:
        """(n,) least of all margins."""
        least: Floats = self._slacks.min(axis=0)
        return least

    @property
    def torque_share(self) -> float:
        """Largest static torque of any motor, over its limit."""
        return max(float(self.torque_shares(motor).max()) for motor in JOINTS)

    @property
    def torque_excess(self) -> float:
        """Largest share of a motor's torque that standing takes beyond what it may."""
        return self.torque_share - FIRM_TORQUE

    @property
    def overloaded(self) -> Motor | None:
        """The motors whose torque is violated most, if that of any is."""
        shares = {motor: float(self.torque_shares(motor).max()) for motor in JOINTS}
        worst = max(shares, key=lambda motor: shares[motor])
        return worst if shares[worst] > FIRM_TORQUE else None

    @property
    def worst(self) -> float:
        """Least of all margins on the path; negative: a bound is violated."""
        return float(self.least_slack.min())

    @property
    def bad(self) -> Ints:
        """Nodes where a bound is violated, or kept with next to nothing to spare."""
        return np.flatnonzero(self.least_slack < SPARE)


_OF_NODES = [one.name for one in fields(NodeMargins)][3:]


def joined(margins: Sequence[NodeMargins]) -> NodeMargins:
    """Those of one path after the other."""
    nodes: dict[str, Any] = {
        name: np.concatenate([getattr(one, name) for one in margins]) for name in _OF_NODES
    }
    return replace(margins[0], **nodes)
