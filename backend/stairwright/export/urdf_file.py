"""URDF: the robot for ROS 2 (robot_state_publisher, RViz, ros2_control) and other tools.

Frames are those of ``/tf`` in our MCAP files: `trunk` is the root, and each link's frame sits at
its joint. ``base_link`` and ``imu`` are fixed to the trunk's centre. Capsules, which URDF does not
have, become a cylinder with a ball at each end. Joints have the names, axes and zero angles that
the robot's own software gives them, where its document tells those. Rotor inertias have no place in
URDF: they are in the comment at the top.
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections.abc import Sequence

import numpy as np

from stairwright.planning.plan import Plan
from stairwright.robot.description import JOINTS, LEGS, Robot
from stairwright.robot.legs import LinkForm
from stairwright.robot.parts import Actuator, Outline
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
Shape = tuple[Vector, float, ET.Element]  # place [m], turn about y [rad], geometry


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
    body = robot.body
    shapes = [_box_round(piece) for piece in body.outline]
    _link(root, TRUNK, "trunk", body.mass, body.inertia, body.com, shapes)
    for frame in FIXED_FRAMES:
        ET.SubElement(root, "link", name=frame)
        _joint(root, f"{frame}_fixed", "fixed", TRUNK, frame, (0, 0, 0))
    for leg, hip in zip(LEGS, hip_offsets(robot).tolist(), strict=True):
        _leg(root, robot, leg, hip)
    ET.indent(root)
    return bytes(ET.tostring(root, encoding="utf-8", xml_declaration=True)) + b"\n"


def _leg(root: ET.Element, robot: Robot, leg: str, hip: Vector) -> None:
    own = robot.legs[0 if leg[0] == "F" else 1]
    named = dict(zip(JOINTS, robot.ros_joints, strict=True))
    counted = dict(
        zip(JOINTS, zip(*map(np.ndarray.tolist, robot.ros_frames), strict=True), strict=True)
    )
    parent, place = TRUNK, hip
    for part in ("thigh", "calf"):
        link: LinkForm = getattr(own, part)
        name, (x, z) = f"{leg}_{part}", link.com
        shapes = [shape for capsule in link.capsules for shape in _capsule(*capsule)]
        _link(root, name, part, link.mass, link.inertia, (x, 0, z), shapes)
        sign, offset = counted[name]
        joint = _joint(root, named[name], "revolute", parent, name, place, offset)
        ends = sorted(sign * (end - offset) for end in getattr(own.limits, part))
        _drive(joint, getattr(own, f"{part}_motor"), sign, (ends[0], ends[1]))
        parent, place = name, (0.0, 0.0, -link.length)
    wheel, name = own.wheel, f"{leg}_wheel"
    disc = _geometry("cylinder", radius=_number(wheel.radius), length=_number(wheel.width))
    _link(root, name, "wheel", wheel.mass, wheel.inertia, (0, 0, 0), [((0, 0, 0), 0.0, disc)])
    sign, offset = counted[name]
    joint = _joint(root, named[name], "continuous", parent, name, place, offset)
    _drive(joint, own.wheel_motor, sign, None)


def _capsule(start: tuple[float, float], end: tuple[float, float], radius: float) -> list[Shape]:
    """A cylinder along the capsule and a ball at each end."""
    (ax, az), (bx, bz) = start, end
    length = _number(math.hypot(bx - ax, bz - az))
    tube = _geometry("cylinder", radius=_number(radius), length=length)
    turn = math.atan2(ax - bx, az - bz)
    balls: list[Shape] = [
        ((x, 0.0, z), 0.0, _geometry("sphere", radius=_number(radius))) for x, z in (start, end)
    ]
    return [(((ax + bx) / 2, 0.0, (az + bz) / 2), turn, tube), *balls]


def _box_round(piece: Outline) -> Shape:
    """The box round a piece of the trunk: URDF has no polygons but in mesh files."""
    points = np.array(piece.points)
    low, high = points.min(axis=0), points.max(axis=0)
    x, z = ((low + high) / 2).tolist()
    length, height = (high - low).tolist()
    return (x, 0.0, z), 0.0, _geometry("box", size=_numbers((length, piece.width, height)))


def _link(
    root: ET.Element,
    name: str,
    part: str,
    mass: float,
    inertia: Vector,
    centre: Vector,
    shapes: Sequence[Shape],
) -> None:
    link = ET.SubElement(root, "link", name=name)
    inertial = ET.SubElement(link, "inertial")
    ET.SubElement(inertial, "origin", xyz=_numbers(centre), rpy="0 0 0")
    ET.SubElement(inertial, "mass", value=_number(mass))
    diagonal = dict(zip(("ixx", "iyy", "izz"), map(_number, inertia), strict=True))
    ET.SubElement(inertial, "inertia", diagonal, ixy="0", ixz="0", iyz="0")
    # Cylinders of URDF stand along z; a wheel's axis is y.
    aside = math.pi / 2 if part == "wheel" else 0.0
    for kind in ("visual", "collision"):
        for place, turn, geometry in shapes:
            shape = ET.SubElement(link, kind)
            ET.SubElement(shape, "origin", xyz=_numbers(place), rpy=_numbers((aside, turn, 0)))
            shape.append(geometry)
            if kind == "visual":
                ET.SubElement(shape, "material", name=part)


def _joint(
    root: ET.Element, name: str, kind: str, parent: str, child: str, place: Vector,
    turn: float = 0.0,
) -> ET.Element:  # fmt: skip
    joint = ET.SubElement(root, "joint", name=name, type=kind)
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=child)
    ET.SubElement(joint, "origin", xyz=_numbers(place), rpy=_numbers((0, turn, 0)))
    return joint


def _drive(
    joint: ET.Element, motor: Actuator, sign: float, limits: tuple[float, float] | None
) -> None:
    ET.SubElement(joint, "axis", xyz=f"0 {sign:g} 0")
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
    inertias = [
        f"{name} {motor.armature!r}" for name, motor in zip(JOINTS, robot.motors, strict=True)
    ]
    rotors = f"rotor inertia [kg m^2]: {', '.join(inertias)}"
    return f" robot_hash: {robot.hash}; units: {UNITS}; frames: {FRAMES}; {rotors} "


def _number(value: float) -> str:
    return repr(float(value)) if value else "0"


def _numbers(values: Sequence[float]) -> str:
    return " ".join(_number(value) for value in values)
