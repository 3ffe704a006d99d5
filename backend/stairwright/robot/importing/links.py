"""One leg's links and wheel, measured: masses, capsules, radius."""

from __future__ import annotations

import math
from dataclasses import dataclass

import mujoco
import numpy as np

from stairwright.arrays import Floats
from stairwright.errors import InputError

from .capsules import Disc2, around, within_disc
from .frame import Frame
from .leg import SideLeg
from .lump import Lump, lump
from .motors import Drive, read_drive
from .report import Notes
from .shapes import Solid, solids
from .source import Source
from .tree import Tree

Moments = tuple[float, float, float]

_ROUND = (int(mujoco.mjtGeom.mjGEOM_CYLINDER), int(mujoco.mjtGeom.mjGEOM_SPHERE))
_BALL = int(mujoco.mjtGeom.mjGEOM_SPHERE)
_PARALLEL = 0.999
_LIGHTEST = 1e-6  # kg, of a robot's document
_THIN, _THICK = 0.04, 0.2  # shares of a link's length: bounds of a radius that is guessed
_INSIDE = 0.7  # of the wheel's radius: no calf is guessed to touch what its wheel rolls on


@dataclass
class LinkPart:
    """A thigh or a calf in its own frame: x, z of the mass centre, moments, capsules."""

    mass: float
    com: Floats
    inertia: Moments
    capsules: list[Disc2]
    drive: Drive


@dataclass
class WheelPart:
    """A wheel: radius and width None where the file shows none."""

    mass: float
    inertia: Moments
    radius: float | None
    width: float | None
    least: float  # m; the wheel reaches farther out than this
    lateral: float  # m; of its middle, along the thigh's axis
    drive: Drive


@dataclass
class Measured:
    """A leg."""

    side: SideLeg
    thigh: LinkPart
    calf: LinkPart
    wheel: WheelPart
    name: str  # of the wheel's body


def measure_leg(source: Source, frame: Frame, tree: Tree, side: SideLeg, notes: Notes) -> Measured:
    """Everything about one leg.

    Raises:
        InputError: If a part weighs nothing; names its body.
    """
    chain = side.chain
    name = source.body(int(source.model.jnt_bodyid[chain.wheel]))
    parts = []
    for link, joint in enumerate((chain.thigh, chain.calf, chain.wheel)):
        bodies = tree.parts[joint]
        whole = lump(source, frame, bodies)
        if whole.mass < _LIGHTEST:
            label = source.body(int(source.model.jnt_bodyid[joint]))
            raise InputError(f"{label!r} weighs nothing: {whole.mass:g} kg", ("file",))
        parts.append((bodies, whole, _moments(whole, side, link), read_drive(source, joint, notes)))
    wheel = _wheel(source, frame, side, name, *parts[2], notes)
    links = []
    for link, (bodies, whole, inertia, drive) in enumerate(parts[:2]):
        com = side.side(whole.com, link)
        most = _THICK * side.lengths[link]
        if link == 1:
            most = min(most, _INSIDE * (wheel.radius or wheel.least))
        capsules = _capsules(source, frame, side, bodies, link, inertia, whole.mass, most, notes)
        links.append(LinkPart(whole.mass, com, inertia, capsules, drive))
    thigh, calf = links
    _fold(side, parts[2][1], calf, name, notes)
    foot = np.array([0.0, -side.lengths[1]])
    reach = wheel.radius or wheel.least
    calf.capsules = [each for each in calf.capsules if not within_disc(each, foot, reach)]
    return Measured(side, thigh, calf, wheel, name)


def _moments(whole: Lump, side: SideLeg, link: int) -> Moments:
    """About the mass centre, along the axes of the link's frame."""
    own = side.axes @ whole.inertia @ side.axes.T
    angle = side.angles[min(link, 1)]
    c, s = math.cos(angle), math.sin(angle)
    axes = np.array([(c, 0.0, -s), (0.0, 1.0, 0.0), (s, 0.0, c)])
    return possible(np.diag(axes @ own @ axes.T).tolist())


def possible(moments: list[float]) -> Moments:
    """Moments without the rounding that makes the largest exceed the sum of the others."""
    fixed = [max(1e-12, float(value)) for value in moments]
    k = int(np.argmax(fixed))
    rest = sum(fixed) - fixed[k]
    if fixed[k] > rest:
        fixed[k] = rest * (1.0 - 1e-12)
    return fixed[0], fixed[1], fixed[2]


def _fold(side: SideLeg, wheel: Lump, calf: LinkPart, name: str, notes: Notes) -> None:
    """A wheel's mass centre lies on its axis here; what it is off goes to the calf.

    So the robot's mass centre is the file's where the wheel stands as in the file's zero.
    """
    off = (side.axes @ wheel.com - side.joints[2])[[0, 2]]
    if np.hypot(*off) > 1e-5:
        notes.warn(
            f"{name!r}: its mass centre lies {1e3 * np.hypot(*off):.2g} mm off its axis; taken on "
            "it, and the calf's moved so that nothing changes where the wheel is at 0"
        )
    angle = side.angles[1]
    c, s = math.cos(angle), math.sin(angle)
    turned = np.array([c * off[0] - s * off[1], s * off[0] + c * off[1]])
    calf.com = calf.com + wheel.mass / calf.mass * turned


def _wheel(
    source: Source, frame: Frame, side: SideLeg, name: str, bodies: list[int], whole: Lump,
    inertia: Moments, drive: Drive, notes: Notes,
) -> WheelPart:  # fmt: skip
    centre = side.joints[2][[0, 2]]
    shapes = solids(source, frame, bodies)
    if not shapes and not any(source.unseen.get(body) for body in bodies):
        shapes = solids(source, frame, bodies, shown=True)
        if shapes:
            notes.warn(f"{name!r}: nothing of it collides; its visible shape taken")
    lateral = float(side.axes[1] @ whole.com)
    # No mass lies farther out than the tyre: the radius of gyration is the least radius.
    least = math.sqrt(inertia[1] / whole.mass)
    for other in solids(source, frame, _fixed_beside(source, side)):
        own = other.cloud @ side.axes.T
        if math.dist(own.mean(axis=0)[[0, 2]], centre) < 0.2 * side.lengths[1]:
            least = max(least, float(np.hypot(*(own[:, [0, 2]] - centre).T).max()) * 0.99)
    if not shapes:
        text = f"{name!r}: its plane is taken at its mass centre, y {lateral:.4g} m"
        notes.assume(text, "hips.half_track")
        return WheelPart(whole.mass, inertia, None, None, least, lateral, drive)
    radius = max(_radius(shape, side, centre) for shape in shapes)
    across = np.concatenate([shape.cloud @ side.axes[1] for shape in shapes])
    width: float | None = float(np.ptp(across))
    if all(shape.kind == _BALL for shape in shapes):
        width = None
    for shape in shapes:
        off = math.dist((side.axes @ shape.centre)[[0, 2]], centre)
        if off > 1e-3 and shape.kind in _ROUND:
            notes.warn(f"{name!r}: its tyre is {1e3 * off:.2g} mm off its axis; the farthest taken")
    middle = float(across.min() + across.max()) / 2
    return WheelPart(whole.mass, inertia, radius, width, least, middle, drive)


def _fixed_beside(source: Source, side: SideLeg) -> list[int]:
    """Bodies fixed to the calf with shapes of their own: motors in the wheel, forks."""
    model = source.model
    calf = int(model.jnt_bodyid[side.chain.calf])
    return [b for b in range(model.nbody) if model.body_weldid[b] == calf and b != calf]


def _radius(shape: Solid, side: SideLeg, centre: Floats) -> float:
    middle = (side.axes @ shape.centre)[[0, 2]]
    level = abs(float(shape.axis @ side.axes[1])) > _PARALLEL
    if shape.kind == _BALL or (shape.kind in _ROUND and level):
        return math.dist(middle, centre) + shape.radius
    points = (shape.cloud @ side.axes.T)[:, [0, 2]]
    return float(np.hypot(*(points - centre).T).max())


def _capsules(
    source: Source, frame: Frame, side: SideLeg, bodies: list[int], link: int,
    inertia: Moments, mass: float, most: float, notes: Notes,
) -> list[Disc2]:  # fmt: skip
    """One capsule round each shape; a guess, of radius `most` at most, where a mesh is missing or
    there is none.
    """
    found = [around(side.side(shape.cloud, link)) for shape in solids(source, frame, bodies)]
    unseen = [source.body(body) for body in bodies if source.unseen.get(body)]
    if found and not unseen:
        return found
    length = side.lengths[link]
    thick = math.sqrt(2.0 * min(inertia) / mass)  # a rod with this moment about its own axis
    radius = float(np.clip(thick, min(_THIN * length, most), most))
    label = unseen[0] if unseen else source.body(bodies[0])
    why = "its collision mesh was not sent" if unseen else "it has no collision shape"
    notes.assume(
        f"{label!r}: {why}; a capsule of radius {radius:.3g} m from joint to joint taken, as thick "
        "as a rod of its inertia"
    )
    return [*found, Disc2(np.zeros(2), np.array([0.0, -length]), radius)]
