"""The dense trajectory that a plan asks for: what the controller tracks, for every method."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stairwright.arrays import Floats

# Columns of `Reference.planned`, and of everything that is made from it.
WHEELS = slice(0, 2)
JOINTS = slice(2, 6)
PITCH = 6
COM = slice(7, 9)
TRUNK = slice(9, 11)


@dataclass(frozen=True)
class Reference:
    """Samples along a plan. SI units, world frame; order of pairs: front, rear.

    Attributes:
        progress: (n,) mean arc length of the wheels since the start [m]; rises strictly.
        time: (n,) planned time since the start [s]; rises strictly.
        trunk: (n, 3) trunk point x, z [m] and pitch about +y [rad].
        q: (n, 4) planar joints: front thigh, front calf, rear thigh, rear calf [rad].
        wheel_progress: (n, 2) arc length of each wheel pair along the wheel-centre curve [m].
        com: (n, 2) centre of mass of the whole robot, x and z [m].
        normals: (n, 2, 2) unit normal of the planned contact of each wheel pair, x and z. At a
            concave corner it is that of the face ahead.
        contacts: (n, 2, 2) planned contact points, x and z [m].
        forces: (n, 2, 2) static force of each wheel pair in its contact frame [N]: tangential
            (along the terrain, positive forward: (nz, -nx)) and normal. The equilibrium with the
            least friction need; outside the cones where there is none inside.
    """

    progress: Floats
    time: Floats
    trunk: Floats
    q: Floats
    wheel_progress: Floats
    com: Floats
    normals: Floats
    contacts: Floats
    forces: Floats

    @property
    def planned(self) -> Floats:
        """(n, 11): the wheels' arc lengths, joints, pitch, CoM, trunk point."""
        pitch, trunk = self.trunk[:, 2:], self.trunk[:, :2]
        return np.hstack([self.wheel_progress, self.q, pitch, self.com, trunk])

    @property
    def duration(self) -> float:
        """Planned time of the whole trajectory [s]."""
        return float(self.time[-1])
