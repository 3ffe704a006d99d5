"""The robot turned about: its rear leads, as robots with legs are often walked down stairs.

Everything that plans, simulates and draws takes the turned robot for one whose rear legs are its
front ones; the frames of the contract stay, x in the direction of travel. What the robot's own
software knows of its joints goes with them, by `joint_names` and `joint_frames`.
"""

from __future__ import annotations

from typing import Any, Literal

from .description import JOINTS, Robot
from .parts import JointFrame, Joints, LegLimits, Link, Point, Range, RearLegs

Facing = Literal["forward", "backward"]  # which end leads: the front, or the rear

# Which leg stands in the place of each once the robot is turned.
OTHER_END = {"FL": "RR", "FR": "RL", "RL": "FR", "RR": "FL"}


def turned(robot: Robot) -> Robot:
    """The robot turned by half a turn about z: x, y and every joint's angle change their sign.

    Turned twice it is the same robot again.
    """
    trunk, hips, points = robot.trunk, robot.hips, robot.collision_points
    x, y, z = trunk.com
    outline = [
        piece.model_copy(update={"points": [_point(p) for p in piece.points]})
        for piece in trunk.outline
    ]
    changed: dict[str, Any] = {
        "trunk": trunk.model_copy(update={"com": (-x, -y, z), "outline": outline}),
        "hips": hips.model_copy(update={"front": _point(hips.rear), "rear": _point(hips.front)}),
        "joints": Joints(front=_limits(robot.joints.rear), rear=_limits(robot.joints.front)),
        "joint_names": _names(robot),
        "joint_frames": _frames(robot),
        **_legs(robot),
    }
    if robot.payload is not None:
        place = _point(robot.payload.place)
        changed["payload"] = robot.payload.model_copy(update={"place": place})
    if points is not None:
        moved = [_point(p) for p in points.trunk]
        changed["collision_points"] = points.model_copy(update={"trunk": moved})
    return robot.model_copy(update=changed | {"schema_": "stairwright/robot/2"})


def symmetric(robot: Robot) -> bool:
    """Whether the turned robot is the same but for what its joints are called."""
    return _form(robot) == _form(turned(robot))


def opposite(joint: str) -> str:
    """The joint that stands in the place of `joint` once the robot is turned."""
    leg, part = joint.split("_")
    return f"{OTHER_END[leg]}_{part}"


def _form(robot: Robot) -> dict[str, Any]:
    form = robot.model_dump(exclude={"schema_", "joint_names", "joint_frames"})
    points = form.get("collision_points", {})
    return form | {"collision_points": {part: sorted(each) for part, each in points.items()}}


def _legs(robot: Robot) -> dict[str, Any]:
    """Links, wheels and motors: what the rear legs have leads."""
    front = _parts(robot)
    rear = _parts(robot.rear or RearLegs())
    leading = {name: rear[name] or own for name, own in front.items()}
    following = {name: own if rear[name] else None for name, own in front.items()}
    return {**leading, "rear": RearLegs(**following) if any(following.values()) else None}


def _parts(legs: Robot | RearLegs) -> dict[str, Any]:
    return {
        "thigh": legs.thigh and _link(legs.thigh),
        "calf": legs.calf and _link(legs.calf),
        "wheel": legs.wheel,
        "actuators": legs.actuators,
    }


def _point(point: Point) -> Point:
    return 0.0 - point[0], point[1]  # not -0.0, which documents would show


def _range(limits: Range) -> Range:
    return -limits[1], -limits[0]


def _limits(limits: LegLimits) -> LegLimits:
    return LegLimits(thigh=_range(limits.thigh), calf=_range(limits.calf))


def _link(link: Link) -> Link:
    shape = [
        part.model_copy(update={"start": _point(part.start), "end": _point(part.end)})
        for part in link.shape
    ]
    com = _point(link.com) if isinstance(link.com, tuple) else link.com
    return link.model_copy(update={"com": com, "shape": shape})


def _names(robot: Robot) -> dict[str, str]:
    own = dict(zip(JOINTS, robot.ros_joints, strict=True))
    names = {joint: own[opposite(joint)] for joint in JOINTS}
    return {joint: name for joint, name in names.items() if name != joint}


def _frames(robot: Robot) -> dict[str, JointFrame]:
    frames = {}
    for joint in JOINTS:
        known = robot.joint_frames.get(opposite(joint), JointFrame())
        frame = JointFrame(sign=-known.sign, offset=0.0 - known.offset)  # type: ignore[arg-type]
        if frame != JointFrame():
            frames[joint] = frame
    return frames
