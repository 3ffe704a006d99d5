"""Robots of which one quantity is changed, everything else kept."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from stairwright.planning.smoothing.node_margins import Motor
from stairwright.robot.description import Robot

STRONGEST = 1000.0  # Nm; the most that a motor is described with


def _changed(robot: Robot, change: Callable[[dict[str, Any]], None]) -> Robot:
    """A new robot (nothing cached) whose document `change` has changed."""
    data = robot.model_dump()
    change(data)
    return Robot.model_validate(data)


def _parts(data: dict[str, Any], *names: str) -> Iterator[dict[str, Any]]:
    """The parts of these names of all legs, where the document has them."""
    for legs in (data, data.get("rear") or {}):
        yield from (legs[name] for name in names if legs.get(name))


def longer(robot: Robot, factor: float) -> Robot:
    """The robot with thighs and calves longer by `factor`."""

    def change(data: dict[str, Any]) -> None:
        for link in _parts(data, "thigh", "calf"):
            link["length"] *= factor
            if isinstance(link["com"], (tuple, list)):
                link["com"] = [link["com"][0], link["com"][1] * factor]
            for piece in link.get("shape", []):
                for end in ("start", "end"):
                    piece[end] = [piece[end][0], piece[end][1] * factor]

    return _changed(robot, change)


def flatter(robot: Robot, height: float) -> Robot:
    """The robot whose trunk is `height` high, all its pieces lower by the same factor."""
    factor = height / robot.trunk.size[2]

    def change(data: dict[str, Any]) -> None:
        trunk = data["trunk"]
        trunk["size"] = [*trunk["size"][:2], height]
        for piece in trunk.get("outline", []):
            piece["points"] = [(x, z * factor) for x, z in piece["points"]]

    return _changed(robot, change)


def wider(robot: Robot, part: str, extra: float) -> Robot:
    """The robot with the range of `part` (thigh, calf) `extra` rad wider, half at each end."""
    legs: dict[str, Any] = {}
    for name in ("front", "rear"):
        leg = getattr(robot.joints, name).model_dump()
        low, high = leg[part]
        wide = [low - extra / 2, high + extra / 2]
        if part == "calf":  # the knee keeps its side and does not fold onto itself
            wide = [
                max(wide[0], 0.05 if low > 0 else -3.1),
                min(wide[1], 3.1 if low > 0 else -0.05),
            ]
        legs[name] = leg | {part: tuple(wide)}
    return _changed(robot, lambda data: data.update(joints=legs))


def loaded(robot: Robot, mass: float) -> Robot:
    """The robot that carries `mass` [kg] in the place of its payload."""
    return _changed(robot, lambda data: data["payload"].update(mass=mass))


def balanced(robot: Robot, factor: float) -> Robot:
    """The robot whose trunk has its mass centre `factor` times as far ahead or behind."""
    x, y, z = robot.trunk.com
    return _changed(robot, lambda data: data["trunk"].update(com=(factor * x, y, z)))


def farther(robot: Robot, factor: float) -> Robot:
    """The robot with its hips farther apart by `factor`; the trunk's centre is their middle."""
    (front, z_front), (rear, z_rear) = robot.hips.front, robot.hips.rear
    places = {"front": (factor * front, z_front), "rear": (factor * rear, z_rear)}
    return _changed(robot, lambda data: data["hips"].update(places))


def stronger(robot: Robot, motor: Motor, factor: float) -> Robot:
    """The robot whose leg or wheel motors are stronger by `factor`."""

    def change(data: dict[str, Any]) -> None:
        for motors in _parts(data, "actuators"):
            for name in ("wheel",) if motor == "wheel" else ("leg", "thigh", "calf"):
                if motors.get(name):
                    motors[name]["torque"] = min(motors[name]["torque"] * factor, STRONGEST)

    return _changed(robot, change)
