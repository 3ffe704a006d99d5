"""From a compiled file to a robot's document."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from stairwright.documents import parse
from stairwright.errors import InputError
from stairwright.robot.description import Robot

from .alike import Alike, find_alike
from .frame import Frame, find_frame, upright
from .holding import hold_joints
from .leg import SideLeg, side_leg
from .links import Measured, measure_leg
from .motor_documents import actuators
from .pair import Pair, link_document, pair_of
from .report import JointMap, Notes
from .source import Source
from .stance import nominal_height
from .tree import Tree, find_legs
from .trunk import trunk_document

_ROS_NAME = re.compile(r"[A-Za-z][\w/.-]{0,99}", re.ASCII)
_LEGS = ("FL", "FR", "RL", "RR")
_PARTS = ("thigh", "calf", "wheel")
_MOST_UNLIKE_RADII = 1e-3  # m between front and rear wheels


@dataclass(frozen=True)
class Reading:
    """A robot and how it was read.

    Attributes:
        robot: The document.
        source: The model; its abduction and free joints stand where they are held.
        frame: Our axes.
        centre: (3,) the trunk point in our frame [m].
        legs: By our names.
        planes: Where each wheel's middle lies along its thigh's axis [m].
        held: Joints that are not ours, and where they are held.
    """

    robot: Robot
    source: Source
    frame: Frame
    centre: np.ndarray
    legs: dict[str, SideLeg]
    planes: dict[str, float]
    held: dict[int, float]

    @property
    def joints(self) -> dict[str, JointMap]:
        """Of the 12 joints, by our names."""
        return {
            f"{name}_{part}": own
            for name, leg in self.legs.items()
            for part, own in zip(_PARTS, leg.maps, strict=True)
        }


def assemble(
    source: Source,
    notes: Notes,
    *,
    abduction: float = 0.0,
    wheel_radius: float | None = None,
    hold: Mapping[str, float],
    known: Sequence[Robot] = (),
    origin: str = "",
) -> Reading:
    """The robot in `source`, whose joints in `hold` are rigid there [rad or m].

    Raises:
        InputError: If it is not one of four legs with a thigh, a calf and a wheel each.
    """
    rigid = hold_joints(source, hold, notes)
    tree = find_legs(source, rigid)
    frame = find_frame(source, tree, notes)
    held = {
        joint: float(source.model.qpos0[source.model.jnt_qposadr[joint]])
        for joint in (*tree.free, *tree.steering)
    } | rigid
    others = [joint for joint in tree.free if joint not in rigid]
    if others:
        notes.warn(f"joints of no leg stand where the file's zero is, unless `hold` says where: "
                   f"{_positions(source, others, held)}")  # fmt: skip
    if tree.steering:
        between = _positions(source, tree.steering, held)
        notes.assume(f"joints between calf and wheel are held [rad]: {between}")
    abducted = upright(source, tree, frame, abduction, notes)
    held |= abducted
    source.set(held)
    sides = [side_leg(source, frame, chain, notes) for chain in tree.legs]
    measured = _placed([measure_leg(source, frame, tree, side, notes) for side in sides])
    legs = {name: leg.side for name, leg in measured.items()}
    pairs = (
        pair_of(measured["FL"], measured["FR"], "front", notes),
        pair_of(measured["RL"], measured["RR"], "rear", notes),
    )
    alike = find_alike(pairs, known)
    radius, width = _wheels(pairs, wheel_radius, alike, notes)
    document, centre = _document(source, tree, frame, pairs, radius, width, alike, notes)
    document |= {
        "name": _name(source.name),
        "nominal_height": nominal_height(source, legs, pairs, radius, notes),
        "abduction": abduction,
        "held_joints": dict(hold),
        "source": origin,
        "joint_names": _names(legs),
        "joint_frames": _frames(legs),
    }
    if abducted:
        at = _positions(source, list(abducted), abducted)
        notes.assume(f"abduction joints are locked [rad]: {at}")
    _note_maps(legs, notes)
    _note_ranges(source, legs, notes)
    document["assumed"] = notes.assumed
    document["assumed_fields"] = {
        path: sentence for path, sentence in notes.assumed_fields.items() if _stands(path, document)
    }
    try:
        robot = parse(Robot, document)
    except InputError as error:
        raise InputError(f"does not make a robot: {error}", ("file",)) from None
    planes = {name: leg.wheel.lateral for name, leg in measured.items()}
    return Reading(robot, source, frame, centre, legs, planes, held)


def _positions(source: Source, joints: list[int], held: Mapping[int, float]) -> str:
    """Names, and where they stand."""
    return ", ".join(f"{source.joint(joint)} {held[joint]:.4g}" for joint in joints)


def _placed(legs: list[Measured]) -> dict[str, Measured]:
    """The legs by our names, front and rear by x, left and right by y."""

    def hip(leg: Measured) -> np.ndarray:
        place: np.ndarray = leg.side.axes.T @ leg.side.joints[0]
        return place

    order = sorted(legs, key=lambda leg: -float(hip(leg)[0]))
    found = {}
    for where, pair in (("F", order[:2]), ("R", order[2:])):
        pair.sort(key=lambda leg: -leg.wheel.lateral)
        for side, leg in zip("LR", pair, strict=True):
            if (leg.wheel.lateral > 0) != (side == "L"):
                raise InputError(
                    f"{leg.name!r}: there must be two legs on each side, in front and behind",
                    ("file",),
                )
            found[where + side] = leg
    return {name: found[name] for name in _LEGS}


def _wheels(
    pairs: tuple[Pair, Pair], given: float | None, alike: Alike | None, notes: Notes
) -> tuple[float, list[float]]:
    """One radius for all wheels, and the widths in front and behind [m]."""
    known = [pair.wheel.radius for pair in pairs if pair.wheel.radius is not None]
    fields = [f"{pair.path}wheel.radius" for pair in pairs]
    if given is not None:
        radius = given
    elif len(known) == 2 and abs(known[0] - known[1]) > _MOST_UNLIKE_RADII:
        raise InputError(
            f"front and rear wheels differ: radii {known[0]:.4g} and {known[1]:.4g} m", ("file",)
        )
    elif known:
        radius = sum(known) / len(known)
    elif alike is not None:
        radius = alike.robot.wheel.radius
        notes.assume(f"wheel radius {radius:.4g} m: no shape of a wheel was sent; as the preset "
                     f"{alike.robot.name}, which has the same legs", *fields)  # fmt: skip
    else:
        discs = [math.sqrt(2 * pair.wheel.inertia[1] / pair.wheel.mass) for pair in pairs]
        radius = max(*discs, *(pair.wheel.least for pair in pairs))
        notes.assume(f"wheel radius {radius:.4g} m: no shape of a wheel was sent; that of a disc "
                     "with its inertia", *fields)  # fmt: skip
        notes.warn(f"the wheels' radius of {radius:.4g} m is a guess: give it, or send the meshes")
    widths = []
    for pair in pairs:
        width = pair.wheel.width or (alike.robot.wheel.width if alike else 0.5 * radius)
        if pair.wheel.width is None:
            text = f"width of the {pair.name} wheels {width:.4g} m: their shape does not say"
            notes.assume(text, f"{pair.path}wheel.width")
        widths.append(width)
    return radius, widths


def _document(
    source: Source, tree: Tree, frame: Frame, pairs: tuple[Pair, Pair], radius: float,
    widths: list[float], alike: Alike | None, notes: Notes,
) -> tuple[dict[str, Any], np.ndarray]:  # fmt: skip
    front, rear = pairs
    middle = (front.hip + rear.hip) / 2
    lateral = (front.middle + rear.middle) / 2
    centre = np.array([middle[0], lateral, middle[1]])
    if abs(front.half_track - rear.half_track) > 1e-4:
        notes.warn(f"the wheels' planes are {front.half_track:.4g} m from the middle in front, "
                   f"{rear.half_track:.4g} m behind; mean taken")  # fmt: skip
    bodies = tree.trunk + [
        body for leg in tree.legs if leg.abduction is not None for body in tree.parts[leg.abduction]
    ]
    trunk = trunk_document(source, frame, bodies, centre, notes)
    mass = trunk["mass"] + 2 * sum(
        part.mass for pair in pairs for part in (pair.thigh, pair.calf, pair.wheel)
    )
    ends = []
    for pair, width in zip(pairs, widths, strict=True):
        ends.append({
            "thigh": link_document(pair.thigh, pair.lengths[0]),
            "calf": link_document(pair.calf, pair.lengths[1]),
            "wheel": {"radius": radius, "width": width, "mass": pair.wheel.mass,
                      "inertia": pair.wheel.inertia},
            "actuators": actuators(pair, radius, mass, source.kind,
                                   {} if alike is None else alike.motors, notes),
        })  # fmt: skip
    unlike = {key: ends[1][key] for key in ends[0] if not _same(ends[0][key], ends[1][key])}
    document = {
        "schema": "stairwright/robot/2",
        "trunk": trunk,
        "hips": {
            "front": tuple((front.hip - middle).tolist()),
            "rear": tuple((rear.hip - middle).tolist()),
            "half_track": (front.half_track + rear.half_track) / 2,
        },
        **ends[0],
        "rear": unlike or None,
        "joints": {pair.name: {"thigh": pair.limits[0], "calf": pair.limits[1]} for pair in pairs},
    }
    return document, centre


def _stands(path: str, document: dict[str, Any]) -> bool:
    """Whether a document has a field: of rear legs it has what they have unlike the front ones."""
    here: Any = document
    for name in path.split("."):
        here = (here or {}).get(name)
    return here is not None


def _same(a: Any, b: Any) -> bool:
    """Alike but for rounding."""
    if isinstance(a, dict):
        return isinstance(b, dict) and a.keys() == b.keys() and all(_same(a[k], b[k]) for k in a)
    if isinstance(a, (list, tuple)):
        return len(a) == len(b) and all(_same(x, y) for x, y in zip(a, b, strict=True))
    if isinstance(a, float):
        return math.isclose(a, b, rel_tol=1e-9, abs_tol=1e-12)
    return bool(a == b)


def _name(given: str) -> str:
    kept = "".join(c if c.isalnum() or c in " .+-_" else "-" for c in given).strip()
    return kept[:100] or "imported"


def _names(legs: dict[str, SideLeg]) -> dict[str, str]:
    """What the file calls the joints, where ROS could."""
    found = {}
    for name, leg in legs.items():
        for part, own in zip(_PARTS, leg.maps, strict=True):
            if _ROS_NAME.fullmatch(own.name) and own.name != f"{name}_{part}":
                found[f"{name}_{part}"] = own.name
    used = [*found.values(), *(f"{n}_{p}" for n in legs for p in _PARTS if f"{n}_{p}" not in found)]
    return found if len(set(used)) == len(used) else {}


def _frames(legs: dict[str, SideLeg]) -> dict[str, dict[str, float]]:
    """How the file counts the joints that it counts unlike us."""
    return {
        f"{name}_{part}": {"sign": int(own.sign), "offset": own.offset}
        for name, leg in legs.items()
        for part, own in zip(_PARTS, leg.maps, strict=True)
        if own.sign < 0 or own.offset
    }


def _note_maps(legs: dict[str, SideLeg], notes: Notes) -> None:
    maps = [own for leg in legs.values() for own in leg.maps]
    turned = [own.name for own in maps if own.sign < 0]
    if turned:
        notes.warn(f"{len(turned)} of 12 joints turn about -y ({', '.join(turned[:4])} ...): signs "
                   "turned, so that positive swings a leg backward")  # fmt: skip
    shifted = [own for own in maps if abs(own.offset) > 1e-9]
    if shifted:
        shown = ", ".join(f"{own.name} {own.offset:+.5g}" for own in shifted[:8])
        notes.warn(f"zero angles shifted [rad], so that 0 is a straight leg: {shown}")
    if turned or shifted:
        notes.assume(
            "plans and recordings are in our angles: the file's = sign * (ours - offset); ROS "
            "messages and URDF are in the file's"
        )


def _note_ranges(source: Source, legs: dict[str, SideLeg], notes: Notes) -> None:
    for name, leg in legs.items():
        end = "front" if name.startswith("F") else "rear"
        for part, joint in (("thigh", leg.chain.thigh), ("calf", leg.chain.calf)):
            if not source.model.jnt_limited[joint]:
                text = f"{source.joint(joint)!r} has no range: once round each way taken"
                notes.assume(text, f"joints.{end}.{part}")
