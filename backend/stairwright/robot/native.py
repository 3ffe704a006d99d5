"""The robot as the native core sees it (native/include/stairwright/robot.hpp)."""

from __future__ import annotations

import math

import numpy as np

from stairwright import _core
from stairwright.arrays import Floats

from .legs import Body, Leg, LinkForm
from .parts import Actuator


def native_robot(
    body: Body, legs: tuple[Leg, Leg], half_track: float, nominal_height: float
) -> _core.Robot:
    """The planar robot of a document's parts; lengths in m."""
    outline = [_core.Polygon(_anticlockwise(piece.points)) for piece in body.outline]
    x, _, z = body.com
    trunk = _core.Trunk(body.mass, body.inertia[1], _core.Vec2(x, z), outline)
    return _core.Robot(trunk, [_leg(leg) for leg in legs], half_track, nominal_height)


def _leg(leg: Leg) -> _core.Leg:
    return _core.Leg(
        _core.Vec2(*leg.hip),
        _link(leg.thigh),
        _link(leg.calf),
        _core.Wheel(leg.wheel.radius, leg.wheel.mass, leg.wheel.inertia[1]),
        _core.Range(*_thigh_range(leg)),
        _core.Range(*leg.limits.calf),
        _motor(leg.thigh_motor),
        _motor(leg.calf_motor),
        _motor(leg.wheel_motor),
        leg.knee,
    )


def _thigh_range(leg: Leg) -> tuple[float, float]:
    """Of thighs that turn all the way round the turn about a leg that hangs half folded: each
    posture has one angle then, and is far from where that would jump.
    """
    low, high = leg.limits.thigh
    if high - low <= 2.0 * math.pi:
        return low, high
    middle = min(max(-0.25 * math.pi * leg.knee, low + math.pi), high - math.pi)
    return middle - math.pi, middle + math.pi


def _link(link: LinkForm) -> _core.Link:
    shape = [_core.Capsule(_core.Vec2(*a), _core.Vec2(*b), r) for a, b, r in link.capsules]
    end = _core.Vec2(0.0, -link.length)
    return _core.Link(end, _core.Vec2(*link.com), link.mass, link.inertia[1], shape)


def _motor(actuator: Actuator) -> _core.Motor:
    return _core.Motor(actuator.torque, actuator.speed, actuator.armature, actuator.damping)


def _anticlockwise(points: list[tuple[float, float]]) -> Floats:
    p = np.array(points, float)
    q = np.roll(p, -1, axis=0)
    area = float((p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum())
    return p if area > 0.0 else p[::-1].copy()
