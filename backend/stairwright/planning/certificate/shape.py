"""The robot as the certificate's native part sees it (native/include/stairwright/certificate).

From the description, as the planner's is (`stairwright.robot.native`), and not from the planner's.
"""

from __future__ import annotations

from stairwright import _core
from stairwright.robot.description import Robot
from stairwright.robot.legs import Leg, LinkForm


def shape_of(robot: Robot) -> _core.CertificateRobot:
    """What distances and balance are told by."""
    body = robot.body
    x, _, z = body.com
    return _core.CertificateRobot(
        trunk=[piece.points for piece in body.outline], trunk_mass=body.mass, trunk_com=(x, z),
        legs=[_leg(leg) for leg in robot.legs], wheel_radius=robot.wheel.radius,
    )  # fmt: skip


def _leg(leg: Leg) -> _core.CertificateLeg:
    return _core.CertificateLeg(leg.hip, _link(leg.thigh), _link(leg.calf), leg.wheel.mass)


def _link(link: LinkForm) -> _core.CertificateLink:
    return _core.CertificateLink(link.length, link.mass, link.com, link.capsules)
