"""Static equilibrium for the certificate: which faces wheels touch, and whether they can hold it.

Written for the certificate alone (native/src/certificate/equilibrium.cpp); the planner's statics
are another method.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stairwright import _core
from stairwright.arrays import Flags, Floats

WHEEL_GAP = 0.002  # m; a wheel this near to the ground touches it
TOUCH = 1.01e-4  # m; a second face no farther from a wheel is touched truly, not just nearly
STRONGEST = _core.CERTIFICATE_STRONGEST  # robot weights; larger forces are no equilibrium
MOST_FACES = 3  # most faces that one wheel touches


@dataclass(frozen=True)
class NearFaces:
    """Where wheels (n,) are near to the profile: up to three points, one a face, nearest first.

    Attributes:
        points: (n, 3, 2) of the profile [m].
        normals: (n, 3, 2) from there towards the wheel's centre.
        distances: (n, 3) of the centre; infinite where there is no such face [m].
    """

    points: Floats
    normals: Floats
    distances: Floats

    def touched(self, reach: float, further: Floats) -> Flags:
        """Whether faces (n, 3) are touched.

        The nearest face counts within `reach` of the centre, any other within `further` (n,) [m].
        """
        most = np.repeat(further[:, None], MOST_FACES, axis=1)
        most[:, 0] = reach
        return self.distances <= most


def balanced(near: NearFaces, touched: Flags, com_x: Floats, friction: float) -> Flags:
    """Whether forces inside the friction cones of all touching faces balance the weight.

    Args:
        near: Faces near to the front and the rear wheel of each of n samples in turn (2 n,).
        touched: (2 n, 3) which of them wheels touch.
        com_x: (n,) x of the centre of mass [m].
        friction: Coulomb friction.

    Returns:
        (n,) flags.
    """
    return _core.certificate_balanced(near.points, near.normals, touched, com_x, friction)


def touching(
    vertices: Floats, centres: Floats, reach: float, further: Floats
) -> tuple[Floats, Floats, Flags]:
    """Where wheels at `centres` (n, 2) touch the profile, one contact per face, nearest first.

    The nearest face counts within `reach` of the centre, any other within `further` (n,) [m].

    Returns:
        (n, 3, 2) points, (n, 3, 2) unit normals towards the centre, (n, 3) whether there is one.
    """
    sight = max(reach, float(further.max(initial=0.0)))
    near = near_faces(_core.CertificateGround(vertices), centres, sight)
    return near.points, near.normals, near.touched(reach, further)


def near_faces(ground: _core.CertificateGround, centres: Floats, sight: float) -> NearFaces:
    """The faces of the ground within `sight` of wheels at `centres` (n, 2) [m]."""
    return NearFaces(*ground.faces(centres, sight))
