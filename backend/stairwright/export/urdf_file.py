"""URDF: the robot for ROS 2 (robot_state_publisher, RViz, ros2_control) and other tools.

Frames are those of ``/tf`` in our MCAP files: `trunk` is the root, and each link's frame sits at
its joint. ``base_link`` and ``imu`` are fixed to the trunk's centre. Capsules, which URDF does not
have, become a cylinder with a ball at each end. Rotor inertias have no place in URDF: they are in
the comment at the top.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections.abc import Sequence

from stairwright.planning.plan import Plan
from stairwright.robot.description import JOINTS, LEGS, Actuator, Link, Robot
from stairwright.robot.spatial import hip_offsets

from .columns import FRAMES, UNITS

TRUNK = "trunk"
FIXED_FRAMES = ("base_link", "imu")  # at the trunk's centre
_COLOURS = {
    "trunk": (0.16, 0.22, 0.32),
    "thigh": (0.90, 0.55, 0.15),
    "calf": (0.75, 0.78, 0.82),
    "wheel": (0.10, 0.10, 0.12),
}
Vector = Sequence[float]


def plan_urdf(plan: Plan) -> bytes:
    """The robot of a plan."""
    return robot_urdf(plan.robot_description)


def robot_urdf(robot: Robot) -> bytes:
    """One self-contained XML file without meshes."""
    root = ET.Element("robot", name=robot.name)
    root.append(ET.Comment(_about(robot)))
    for part, colour in _COLOURS.items():
        material = ET.SubElement(root, "material", name=part)
        ET.SubElement(material, "color", rgba=_numbers((*colour, 1.0)))
    trunk, centre = robot.trunk, (0.0, 0.0, 0.0)
    box = _geometry("box", size=_numbers(trunk.size))
    _link(root, TRUNK, "trunk", trunk.mass, trunk.inertia, centre, [(centre, box)])
    for frame in FIXED_FRAMES:
        ET.SubElement(root, "link", name=frame)
        _joint(root, f"{frame}_fixed", "fixed", TRUNK, frame, (0, 0, 0))
    for leg, hip in zip(LEGS, hip_offsets(robot).tolist(), strict=True):
        _leg(root, robot, leg, hip)
    ET.indent(root)
    return bytes(ET.tostring(root, encoding="utf-8", xml_declaration=True)) + b"\n"


def _leg(root: ET.Element, robot: Robot, leg: str, hip: Vector) -> None:
    limits = robot.joints.front if leg[0] == "F" else robot.joints.rear
    named = dict(zip(JOINTS, robot.ros_joints, strict=True))
    parent, place = TRUNK, hip
    for part in ("thigh", "calf"):
        link, name = getattr(robot, part), f"{leg}_{part}"
        shapes = _capsule(link)
        _link(root, name, part, link.mass, link.inertia, (0, 0, -link.com * link.length), shapes)
        joint = _joint(root, named[name], "revolute", parent, name, place)
        _drive(joint, robot.actuators.leg, getattr(limits, part))
        parent, place = name, (0.0, 0.0, -link.length)
    wheel, name = robot.wheel, f"{leg}_wheel"
    disc = _geometry("cylinder", radius=_number(wheel.radius), length=_number(wheel.width))
    _link(root, name, "wheel", wheel.mass, wheel.inertia, (0, 0, 0), [((0, 0, 0), disc)])
    joint = _joint(root, named[name], "continuous", parent, name, place)
    _drive(joint, robot.actuators.wheel, None)


def _capsule(link: Link) -> list[tuple[Vector, ET.Element]]:
    """A cylinder along the link and a ball at each end."""
    radius = _number(link.radius)
    tube = _geometry("cylinder", radius=radius, length=_number(link.length))
    balls = [((0.0, 0.0, z), _geometry("sphere", radius=radius)) for z in (0.0, -link.length)]
    return [((0.0, 0.0, -link.length / 2), tube), *balls]


def _link(
    root: ET.Element,
    name: str,
    part: str,
    mass: float,
    inertia: Vector,
    centre: Vector,
    shapes: Sequence[tuple[Vector, ET.Element]],
) -> None:
    link = ET.SubElement(root, "link", name=name)
    inertial = ET.SubElement(link, "inertial")
    ET.SubElement(inertial, "origin", xyz=_numbers(centre), rpy="0 0 0")
    ET.SubElement(inertial, "mass", value=_number(mass))
    diagonal = dict(zip(("ixx", "iyy", "izz"), map(_number, inertia), strict=True))
    ET.SubElement(inertial, "inertia", diagonal, ixy="0", ixz="0", iyz="0")
    # Cylinders of URDF stand along z; a wheel's axis is y.
    turn = _numbers((math.pi / 2, 0, 0)) if part == "wheel" else "0 0 0"
    for kind in ("visual", "collision"):
        for place, geometry in shapes:
            shape = ET.SubElement(link, kind)
            ET.SubElement(shape, "origin", xyz=_numbers(place), rpy=turn)
            shape.append(geometry)
            if kind == "visual":
                ET.SubElement(shape, "material", name=part)


def _joint(
    root: ET.Element, name: str, kind: str, parent: str, child: str, place: Vector
) -> ET.Element:
    joint = ET.SubElement(root, "joint", name=name, type=kind)
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    ET.SubElement(joint, "origin", xyz=_numbers(place), rpy="0 0 0")
    return joint


def _drive(joint: ET.Element, motor: Actuator, limits: tuple[float, float] | None) -> None:
    ET.SubElement(joint, "axis", xyz="0 1 0")
    bounds = {"effort": _number(motor.torque), "velocity": _number(motor.speed)}
    if limits is not None:
        bounds |= {"lower": _number(limits[0]), "upper": _number(limits[1])}
    ET.SubElement(joint, "limit", bounds)
    ET.SubElement(joint, "dynamics", damping=_number(motor.damping), friction="0")


def _geometry(kind: str, **sizes: str) -> ET.Element:
    geometry = ET.Element("geometry")
    ET.SubElement(geometry, kind, sizes)
    return geometry


def _about(robot: Robot) -> str:
    rotors = (
        f"rotor inertia [kg m^2]: legs {robot.actuators.leg.armature!r}, "
        f"wheels {robot.actuators.wheel.armature!r}"
    )
    return f" robot_hash: {robot.hash}; units: {UNITS}; frames: {FRAMES}; {rotors} "


def _number(value: float) -> str:
    return repr(float(value)) if value else "0"


def _numbers(values: Sequence[float]) -> str:
    return " ".join(_number(value) for value in values)
