"""The robot as one rigid body pushed at its wheels, in the x-z plane (eqs 1-7).

Each wheel has its own contact frame: x along the terrain (forward), z along its normal; on a
vertical face the slope is 90 degrees. Rows of the maps: force x, force z, moment about +y. The
moment of a force f at the lever arm r is ``r_z f_x - r_x f_z`` (the paper's ``r x``).

The wheel's own inertia is neglected (eq 1), so its traction is ``F_t = tau_wheel / R`` (eq 2).
"""

from __future__ import annotations

import numpy as np

from stairwright._core import GRAVITY
from stairwright.arrays import Floats


def traction(wheel_torque: Floats, radius: float) -> Floats:
    """Tangential force [N] of wheels driven with `wheel_torque` [Nm] (eq 2)."""
    force: Floats = np.asarray(wheel_torque) / radius
    return force


def contact_frames(normals: Floats) -> Floats:
    """(n, 2, 2) contact frames of unit `normals` (n, 2): columns tangent and normal (eq 7)."""
    tangents = np.stack([normals[:, 1], -normals[:, 0]], axis=-1)
    return np.stack([tangents, normals], axis=-1)


def force_map(frames: Floats, levers: Floats) -> Floats:
    """(3, 2n) map from forces in contact frames to the body's wrench (eqs 4-5).

    With lever arms to the wheel centres it is the paper's ``A_c``; to the contact points,
    ``A_wheel``.

    Args:
        frames: (n, 2, 2) contact frames.
        levers: (n, 2) from the centre of mass to where the forces act [m].
    """
    moment = levers[:, 1, None] * frames[:, 0, :] - levers[:, 0, None] * frames[:, 1, :]
    rows = np.concatenate([frames, moment[:, None, :]], axis=1)  # (n, 3, 2)
    return rows.transpose(1, 0, 2).reshape(3, -1)


def wrench(mass: float, acceleration: Floats, moment: float) -> Floats:
    """(3,) the right-hand side ``b``: what gives the body this acceleration (eqs 3 and 6)."""
    return np.array([mass * acceleration[0], mass * (acceleration[1] + GRAVITY), moment])
