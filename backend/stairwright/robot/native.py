"""The robot as the native core sees it (native/include/stairwright/robot.hpp)."""

from __future__ import annotations

import numpy as np

from stairwright import _core

from .description import Actuator, LegLimits, Link, Robot


def native_robot(robot: Robot) -> _core.Robot:
    """The planar robot of a document."""
    length, _, height = robot.trunk.size
    x, z = length / 2, height / 2
    box = _core.Polygon(np.array([(-x, -z), (x, -z), (x, z), (-x, z)]))
    trunk = _core.Trunk(robot.trunk.mass, robot.trunk.inertia[1], _core.Vec2(0.0, 0.0), [box])
    legs = [
        _leg(robot, hip, limits)
        for hip, limits in (
            (robot.hips.front, robot.joints.front),
            (robot.hips.rear, robot.joints.rear),
        )
    ]
    return _core.Robot(trunk, legs, robot.hips.half_track, robot.nominal_height)


def _leg(robot: Robot, hip: tuple[float, float], limits: LegLimits) -> _core.Leg:
    wheel = robot.wheel
    joint, rim = _motor(robot.actuators.leg), _motor(robot.actuators.wheel)
    return _core.Leg(
        _core.Vec2(*hip),
        _link(robot.thigh),
        _link(robot.calf),
        _core.Wheel(wheel.radius, wheel.mass, wheel.inertia[1]),
        _core.Range(*limits.thigh),
        _core.Range(*limits.calf),
        joint,
        joint,
        rim,
        limits.knee,
    )


def _link(link: Link) -> _core.Link:
    end, com = _core.Vec2(0.0, -link.length), _core.Vec2(0.0, -link.com * link.length)
    shape = [_core.Capsule(_core.Vec2(0.0, 0.0), end, link.radius)]
    return _core.Link(end, com, link.mass, link.inertia[1], shape)


def _motor(actuator: Actuator) -> _core.Motor:
    return _core.Motor(actuator.torque, actuator.speed)
