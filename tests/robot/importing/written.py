"""A `files.Design` as text: MJCF and URDF."""

from __future__ import annotations

import math
import re
from xml.sax.saxutils import quoteattr

import numpy as np

from tests.robot.importing.files import LEGS, Design, parts

ANKLES = tuple(f"{leg}_ankle_joint" for leg in LEGS)
BELOW = 0.1  # m from ankle to wheel

# A frame that an exporter wrote as a body.
_NOTHING = (
    '<link name="imu"><inertial><mass value="4e-15"/><inertia ixx="1e-27" ixy="0" ixz="0" '
    'iyy="1e-27" iyz="0" izz="1e-27"/></inertial></link>'
)


def n(*values: float) -> str:
    """Numbers as XML has them."""
    return " ".join(repr(float(value)) for value in values)


def quaternion(roll: float, pitch: float) -> str:
    """Turn about x, then about the parent's y, as wxyz."""
    a, b = math.cos(roll / 2), math.sin(roll / 2)
    c, d = math.cos(pitch / 2), math.sin(pitch / 2)
    return n(c * a, c * b, d * a, -d * b)


def mjcf(design: Design, *, free: bool = True, extra: str = "", motors: str | None = None) -> str:
    """As MJCF: classes, a torque limit in two places, a keyframe."""
    legs = "".join(_leg_mjcf(design, leg) for leg in LEGS)
    x, z = design.trunk_off
    head = (
        f'<body name="head" pos="{n(x + 0.3, 0, z + 0.01)}"><inertial mass="0.4" pos="0.01 0 0" '
        'diaginertia="0.001 0.001 0.001"/><geom class="touch" type="cylinder" size="0.05 0.045"/>'
        f'<geom class="touch" type="sphere" size="0.05" pos="0.01 0 -0.07"/></body>'
        if design.head
        else ""
    )
    actuators = motors if motors is not None else "".join(_motor(design, leg) for leg in LEGS)
    key = _key(design) if design.keyframe else ""
    return f"""<mujoco model={quoteattr(design.name)}>
<compiler angle="radian" autolimits="true" meshdir="assets"/>
<option timestep="0.002"/>
<default><joint damping="0.1" armature="0.01"/>
<default class="shown"><geom type="mesh" contype="0" conaffinity="0" group="2"/></default>
<default class="touch"><geom group="3" density="0"/></default></default>
<asset><mesh name="body" file="body.obj"/><mesh name="tyre" file="tyre.stl"/></asset>
<worldbody><light pos="0 0 3"/><geom name="floor" type="plane" size="5 5 .1"/>
<body name="base" pos="0 0 0.6">{'<freejoint name="root"/>' if free else ""}
<inertial mass="{n(design.base_mass)}" pos="{n(*design.base_com)}"
 fullinertia="0.03 0.1 0.11 0.0002 0.001 -0.0003"/>
<geom class="shown" mesh="body"/>
<geom class="touch" type="box" size="{n(0.19, 0.05, 0.06)}" pos="{n(x, 0, z)}"/>
{head}{legs}</body></worldbody>
<actuator>{actuators}</actuator>{extra}{key}</mujoco>"""


def _leg_mjcf(design: Design, leg: str) -> str:
    text, end = "", ""
    for body in parts(design, leg):
        part = body["part"]
        turn = quaternion(body["turn"], 0) if body["about"] == "x" else quaternion(0, body["turn"])
        limits = ""
        if part in ("thigh", "calf"):
            low, high = design.range_of(leg, part)
            limits = f'range="{n(low, high)}"'
        elif part == "hip":
            limits = 'range="-1.5 1.5"'
        if part == "calf":
            limits += ' actuatorfrcrange="-35 35"'
        shapes = "".join(
            f'<geom class="touch" type="{kind}" size="{n(*size)}" pos="{n(*at)}" '
            f'quat="{quaternion(*turned)}"/>'
            for kind, size, at, turned in body["shapes"]
            if not (part == "wheel" and design.wheel_mesh)
        )
        if part == "wheel" and design.wheel_mesh:
            shapes = '<geom type="mesh" mesh="tyre"/>'
        text += (
            f'<body name="{leg}_{part}" pos="{n(*body["place"])}" quat="{turn}">'
            f'<inertial mass="{n(body["mass"])}" pos="{n(*body["com"])}" '
            f'quat="{quaternion(0, body["frame"])}" diaginertia="{n(*body["moments"])}"/>'
            f'<joint name={quoteattr(design.joint(leg, part))} axis="{n(*body["axis"])}" {limits}/>'
            f"{shapes}"
        )
        end += "</body>"
    return text + end


def _motor(design: Design, leg: str) -> str:
    torques = {"hip": 20, "thigh": 24, "calf": 45, "wheel": 15}
    return "".join(
        f'<motor name="{leg}_{part}" joint={quoteattr(design.joint(leg, part))} '
        f'ctrlrange="{-torque} {torque}"/>'
        for part, torque in torques.items()
    )


def _key(design: Design) -> str:
    angles = []
    for leg in LEGS:
        angles += [0.0] + [
            design.theirs(leg, part, value)
            for part, value in (("thigh", 0.75), ("calf", -1.45), ("wheel", 0.0))
        ]
    return f'<keyframe><key name="home" qpos="0 0 .5 1 0 0 0 {n(*angles)}"/></keyframe>'


def urdf(design: Design, *, extra: str = "") -> str:
    """As URDF: fixed links, a head, visual meshes that are not there."""
    x, z = design.trunk_off
    hull = [("box", (0.19, 0.05, 0.06), (x, 0, z), (0, 0))]
    mesh = "package://maker/meshes/body.dae"
    moments = (0.03, 0.1, 0.11)
    text = [
        f'<?xml version="1.0" encoding="utf-8"?><robot name={quoteattr(design.name)}>',
        _link("base", design.base_mass, design.base_com, 0.0, moments, hull, mesh=mesh),
    ]
    if design.head:
        nose = [
            ("cylinder", (0.05, 0.045), (0, 0, 0), (0, 0)),
            ("sphere", (0.05,), (0.01, 0, -0.07), (0, 0)),
        ]
        text += [
            _link("head", 0.4, (0.01, 0, 0), 0.0, (0.001, 0.001, 0.001), nose),
            _fixed("base", "head", (x + 0.3, 0, z + 0.01)),
            _NOTHING,
            _fixed("head", "imu", (0, 0, 0.03)),
        ]
    for leg in LEGS:
        parent = "base"
        for body in parts(design, leg):
            part, name = body["part"], f"{leg}_{body['part']}"
            shapes = [] if part == "wheel" and design.wheel_mesh else body["shapes"]
            mesh = (
                "package://maker/meshes/tyre.dae" if part == "wheel" and design.wheel_mesh else None
            )
            text.append(
                _link(
                    name,
                    body["mass"],
                    body["com"],
                    body["frame"],
                    body["moments"],
                    shapes,
                    hit=mesh,
                )
            )
            kind, limits = "revolute", ""
            if part in ("thigh", "calf"):
                low, high = design.range_of(leg, part)
                limits = f'lower="{n(low)}" upper="{n(high)}"'
            elif part == "hip":
                limits = 'lower="-1.5" upper="1.5"'
            else:
                kind = "continuous"
            effort, speed = {
                "hip": (20, 25),
                "thigh": (24, 30),
                "calf": (35, 20),
                "wheel": (15, 40),
            }[part]
            rpy = n(body["turn"], 0, 0) if body["about"] == "x" else n(0, body["turn"], 0)
            text.append(
                f'<joint name={quoteattr(design.joint(leg, part))} type="{kind}">'
                f'<origin xyz="{n(*body["place"])}" rpy="{rpy}"/><parent link="{parent}"/>'
                f'<child link="{name}"/><axis xyz="{n(*body["axis"])}"/>'
                f'<limit effort="{effort}" velocity="{speed}" {limits}/>'
                '<dynamics damping="0.05"/></joint>'
            )
            parent = name
    return "\n".join([*text, extra, "</robot>"])


def _link(name, mass, com, frame, moments, shapes, mesh=None, hit=None) -> str:
    ixx, iyy, izz = moments
    text = (
        f'<link name="{name}"><inertial><origin xyz="{n(*com)}" rpy="{n(0, frame, 0)}"/>'
        f'<mass value="{n(mass)}"/><inertia ixx="{n(ixx)}" ixy="0" ixz="0" iyy="{n(iyy)}" iyz="0" '
        f'izz="{n(izz)}"/></inertial>'
    )
    if mesh:
        text += (
            f'<visual><geometry><mesh filename="{mesh}"/></geometry>'
            '<material name="a"/><material name="b"/></visual>'
        )
    if hit:
        text += f'<collision><geometry><mesh filename="{hit}"/></geometry></collision>'
    for kind, size, at, (roll, pitch) in shapes:
        inner = {
            "box": lambda s: f'<box size="{n(*(2 * v for v in s))}"/>',
            "cylinder": lambda s: f'<cylinder radius="{n(s[0])}" length="{n(2 * s[1])}"/>',
            "sphere": lambda s: f'<sphere radius="{n(s[0])}"/>',
        }[kind](size)
        text += (
            f'<collision><origin xyz="{n(*at)}" rpy="{n(roll, pitch, 0)}"/>'
            f"<geometry>{inner}</geometry></collision>"
        )
    return text + "</link>"


def _fixed(parent: str, child: str, place: tuple[float, float, float]) -> str:
    return (
        f'<joint name="{child}_fixed" type="fixed"><origin xyz="{n(*place)}"/>'
        f'<parent link="{parent}"/><child link="{child}"/><axis xyz="0 0 0"/></joint>'
    )


def link(name: str, mass: float, x: float = 0.0) -> str:
    """A URDF link, its mass centre `x` before its frame."""
    return (
        f'<link name="{name}"><inertial><origin xyz="{x} 0 0"/><mass value="{mass}"/><inertia '
        'ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    )


def hinge(name: str, parent: str, child: str, place: str, axis: str) -> str:
    """A URDF joint."""
    return (
        f'<joint name="{name}" type="revolute"><origin xyz="{place}"/><parent link="{parent}"/>'
        f'<child link="{child}"/><axis xyz="{axis}"/>'
        '<limit lower="-2" upper="2" effort="90" velocity="9"/></joint>'
    )


def with_ankles(axis: str) -> str:
    """URDF whose legs have one joint more, `BELOW` above their wheels."""
    text = urdf(Design())
    for leg in LEGS:
        found = re.search(rf'<joint name="{leg}_wheel_joint".*?</joint>', text, re.DOTALL)
        assert found
        place = re.search(r'xyz="([^"]+)"', found[0])
        assert place
        wheel = np.array([float(number) for number in place[1].split()])
        step = wheel * BELOW / np.linalg.norm(wheel)
        own = found[0].replace(place[1], n(*step), 1)
        own = own.replace(f'link="{leg}_calf"', f'link="{leg}_ankle"', 1)
        ankle = hinge(f"{leg}_ankle_joint", f"{leg}_calf", f"{leg}_ankle", n(*wheel - step), axis)
        text = text.replace(found[0], link(f"{leg}_ankle", 0.1) + ankle + own)
    return text
