"""URDF: what MuJoCo needs of it, and what MuJoCo does not keep (motor speeds)."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from dataclasses import dataclass

import numpy as np

from stairwright.errors import InputError

from .report import Notes, listed
from .upload import XACRO

_SHAPES = ("box", "cylinder", "sphere", "capsule", "mesh")
_JOINT_PARTS = ("origin", "parent", "child", "axis", "limit", "dynamics")
_COMPILER = ("inertiafromgeom", "settotalmass", "boundmass", "boundinertia", "angle")
_NOTHING = 1e-9  # kg; frames that exporters write as bodies
_LEAST_MOMENT = 1e-12  # kg m^2, of what MuJoCo takes for a moment at all


@dataclass(frozen=True)
class UrdfLimits:
    """A joint's <limit>: 0 where it is not given."""

    effort: float
    velocity: float


@dataclass(frozen=True)
class Urdf:
    """A cleaned file.

    Attributes:
        text: XML that MuJoCo reads; masses and collision shapes only.
        limits: By joint.
        massless: Links with a shape and without a mass.
        mimics: Joints that follow another one: by name, the other's name.
    """

    text: str
    limits: dict[str, UrdfLimits]
    massless: list[str]
    mimics: dict[str, str]


def clean(root: ET.Element, notes: Notes) -> Urdf:
    """Only links, joints, masses and collision shapes, which is all that a robot is made of here.

    Raises:
        InputError: If links and joints do not make one tree.
    """
    if any(
        "xacro" in element.tag or any("${" in value for value in element.attrib.values())
        for element in root.iter()
    ):
        raise InputError(XACRO, ("file",))
    made = ET.Element("robot", name=root.get("name") or "robot")
    settings = root.find("mujoco/compiler")
    kept = (
        {}
        if settings is None
        else {k: settings.attrib[k] for k in _COMPILER if k in settings.attrib}
    )
    block = ET.SubElement(ET.SubElement(made, "mujoco"), "compiler", kept)
    block.set("fusestatic", "false")
    block.set("discardvisual", "true")
    massless: list[str] = []
    flat: list[str] = []
    for link in root.findall("link"):
        _link(made, link, massless, flat, notes)
    if flat:
        notes.warn(f"collision shapes without a volume are left out: {listed(flat)}")
    limits, mimics = {}, {}
    for joint in root.findall("joint"):
        name = joint.get("name") or ""
        limits[name] = _joint(made, joint)
        follow = joint.find("mimic")
        if follow is not None:
            mimics[name] = follow.get("joint") or ""
    _check_tree(made)
    unbalanced = _unbalanced(made)
    if unbalanced:
        block.set("balanceinertia", "true")
        notes.warn(
            f"{listed(unbalanced)}: no body has these moments of inertia; MuJoCo takes their mean"
        )
    return Urdf(ET.tostring(made, encoding="unicode"), limits, massless, mimics)


def _link(
    made: ET.Element, link: ET.Element, massless: list[str], flat: list[str], notes: Notes
) -> None:
    name = link.get("name") or ""
    new = ET.SubElement(made, "link", name=name)
    inertial = link.find("inertial")
    if inertial is not None:
        new.append(_inertial(inertial, name, notes))
    for collision in link.findall("collision"):
        geometry = collision.find("geometry")
        shape = None if geometry is None else next((s for s in geometry if s.tag in _SHAPES), None)
        if shape is None:
            continue
        if _is_flat(shape):
            flat.append(name)
            continue
        kept = ET.SubElement(new, "collision")
        origin = collision.find("origin")
        if origin is not None:
            ET.SubElement(kept, "origin", _only(origin, "xyz", "rpy"))
        ET.SubElement(ET.SubElement(kept, "geometry"), shape.tag, dict(shape.attrib))
        if inertial is None and name not in massless:
            massless.append(name)


def _is_flat(shape: ET.Element) -> bool:
    """Whether a size is 0: with such shapes some files say that a link collides with nothing."""
    if shape.tag == "mesh":
        return False
    sizes = " ".join(shape.get(name, "") for name in ("size", "radius", "length")).split()
    try:
        return any(float(size) == 0.0 for size in sizes)
    except ValueError:
        return False  # MuJoCo says what is wrong with it


def _inertial(inertial: ET.Element, name: str, notes: Notes) -> ET.Element:
    new = ET.Element("inertial")
    for part in inertial:
        if part.tag in ("origin", "mass", "inertia"):
            ET.SubElement(new, part.tag, dict(part.attrib))
    mass, tensor = new.find("mass"), new.find("inertia")
    kilograms = _number(mass, "value")
    if kilograms < 0:
        raise InputError(f"link {name!r}: its mass is {kilograms:g} kg", ("file",))
    moments = np.linalg.eigvalsh(_tensor(tensor))
    if moments.min() < _LEAST_MOMENT:
        if kilograms > _NOTHING:
            notes.warn(f"link {name!r}: its moments of inertia are not positive; a ball's taken")
        ball = repr(max(_LEAST_MOMENT, 0.4 * kilograms * 0.02**2))
        if tensor is not None:
            new.remove(tensor)
        moments_of = dict.fromkeys(("ixx", "iyy", "izz"), ball)
        ET.SubElement(new, "inertia", moments_of, ixy="0", ixz="0", iyz="0")
    return new


def _joint(made: ET.Element, joint: ET.Element) -> UrdfLimits:
    kind, name = joint.get("type") or "", joint.get("name") or ""
    if kind not in ("revolute", "continuous", "fixed", "prismatic", "floating", "planar"):
        raise InputError(f"joint {name!r}: URDF has no type {kind!r}", ("file",))
    new = ET.SubElement(made, "joint", name=name, type=kind)
    for part in joint:
        if part.tag in _JOINT_PARTS and not (part.tag == "axis" and kind == "fixed"):
            ET.SubElement(new, part.tag, dict(part.attrib))
    limit = joint.find("limit")
    return UrdfLimits(_number(limit, "effort"), _number(limit, "velocity"))


def _check_tree(root: ET.Element) -> None:
    links = {link.get("name") for link in root.findall("link")}
    parents: dict[str | None, str] = {}
    for joint in root.findall("joint"):
        name = joint.get("name") or ""
        ends = {}
        for tag in ("parent", "child"):
            element = joint.find(tag)
            ends[tag] = None if element is None else element.get("link")
            if ends[tag] not in links:
                raise InputError(f"joint {name!r}: there is no link {ends[tag]!r}", ("file",))
        if ends["child"] in parents:
            raise InputError(
                f"link {ends['child']!r} hangs on two joints, {parents[ends['child']]!r} and "
                f"{name!r}: closed chains cannot be read",
                ("file",),
            )
        parents[ends["child"]] = name
    if not links:
        raise InputError("the file has no links", ("file",))
    roots = sorted(str(link) for link in links - parents.keys())
    if len(roots) != 1:
        what = "several links hang on nothing" if roots else "the links form a ring"
        raise InputError(f"{what}: {listed(roots) or 'closed chain'}", ("file",))


def _unbalanced(root: ET.Element) -> list[str]:
    """Links whose largest moment exceeds the sum of the others, which MuJoCo refuses."""
    found = []
    for link in root.findall("link"):
        inertia = link.find("inertial/inertia")
        if inertia is not None:
            a, b, c = np.linalg.eigvalsh(_tensor(inertia))
            if a + b < c:
                found.append(link.get("name") or "")
    return found


def _tensor(inertia: ET.Element | None) -> np.ndarray:
    xx, yy, zz, xy, xz, yz = (
        _number(inertia, f"i{axes}") for axes in ("xx", "yy", "zz", "xy", "xz", "yz")
    )
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _only(element: ET.Element, *names: str) -> dict[str, str]:
    return {name: element.attrib[name] for name in names if name in element.attrib}


def _number(element: ET.Element | None, name: str) -> float:
    text = "0" if element is None else element.get(name, "0")
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value) and name not in ("effort", "velocity"):
        raise InputError(f"<{element.tag if element is not None else ''} {name}={text!r}>: "
                         "must be a finite number", ("file",))  # fmt: skip
    return value if math.isfinite(value) else 0.0
