"""MuJoCo's model of a robot file, at rest in its reference posture."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import Any, Literal

import mujoco
import numpy as np

from stairwright.errors import InputError

from . import mjcf, urdf
from .meshes import provide
from .report import Notes, listed
from .upload import Upload
from .xml import parse

_MOST_BODIES, _MOST_GEOMS = 500, 5000
_LARGEST = 100.0  # m
_HEAVIEST = 2000.0  # kg
_FINITE = (
    "body_quat", "body_iquat", "jnt_pos", "jnt_axis", "jnt_range", "geom_pos", "geom_quat",
    "geom_size", "dof_damping", "dof_armature", "qpos0", "mesh_vert",
)  # fmt: skip
_MESH, _PLANE = int(mujoco.mjtGeom.mjGEOM_MESH), int(mujoco.mjtGeom.mjGEOM_PLANE)
_UNITS = {int(mujoco.mjtJoint.mjJNT_HINGE): "rad", int(mujoco.mjtJoint.mjJNT_SLIDE): "m"}
_SHAPES = tuple(
    int(getattr(mujoco.mjtGeom, f"mjGEOM_{name}"))
    for name in ("SPHERE", "CAPSULE", "ELLIPSOID", "CYLINDER", "BOX", "MESH")
)


@dataclass
class Source:
    """A compiled file.

    Attributes:
        kind: urdf or mjcf.
        name: Of the robot.
        model: MuJoCo's model; the world is its body 0.
        data: At the reference posture (qpos0), the state that positions are read from.
        limits: URDF's <limit> by joint; empty for MJCF.
        mimics: URDF's joints that follow another.
        unseen: How many colliding shapes each body has whose mesh is missing.
    """

    kind: Literal["urdf", "mjcf"]
    name: str
    model: Any
    data: Any
    limits: dict[str, urdf.UrdfLimits]
    mimics: dict[str, str]
    unseen: dict[int, int] = field(default_factory=dict)

    def body(self, index: int) -> str:
        """A body's name, or what stands for one."""
        return self.model.body(index).name or f"body {index}"

    def joint(self, index: int) -> str:
        """A joint's name, or what stands for one."""
        return self.model.joint(index).name or f"joint of {self.body(self.model.jnt_bodyid[index])}"

    def unit(self, index: int) -> str | None:
        """Of a joint's position; None for one that no single number tells."""
        return _UNITS.get(int(self.model.jnt_type[index]))

    def set(self, positions: dict[int, float]) -> None:
        """Put every joint to its reference and those of `positions` elsewhere [rad or m]."""
        self.data.qpos[:] = self.model.qpos0
        for joint, value in positions.items():
            self.data.qpos[self.model.jnt_qposadr[joint]] = value
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)


@dataclass
class Specification:
    """A robot file before it is compiled; it needs no other file.

    Attributes:
        spec: MuJoCo's editable specification.
        own: URDF's own facts; None of MJCF.
        lost: The body of each colliding shape left out.
        weightless: Bodies that had the mass of a mesh that was not sent.
    """

    spec: Any
    own: urdf.Urdf | None
    lost: list[Any] = field(default_factory=list)
    weightless: list[str] = field(default_factory=list)


def read_spec(upload: Upload, notes: Notes) -> Specification:
    """Read a robot file.

    Raises:
        InputError: If it is no robot file.
    """
    root = parse(upload.content, PurePosixPath(upload.name).name)
    own: urdf.Urdf | None = None
    if root.tag == "robot":
        own = urdf.clean(root, notes)
        text = own.text
    elif root.tag == "mujoco":
        text = mjcf.clean(root, upload)
    else:
        raise InputError(f"<{root.tag}> is neither URDF (<robot>) nor MJCF (<mujoco>)", ("file",))
    try:
        spec = mujoco.MjSpec.from_string(text)
    except (ValueError, TypeError) as error:
        raise InputError(f"MuJoCo cannot read it: {_reason(error)}", ("file",)) from None
    spec.compiler.fusestatic = False
    spec.compiler.usethread = False
    if len(spec.bodies) > _MOST_BODIES or len(spec.geoms) > _MOST_GEOMS:
        raise InputError(
            f"more than {_MOST_BODIES} bodies or {_MOST_GEOMS} shapes: no robot", ("file",)
        )
    read = Specification(spec, own)
    _drop_unseen(read, upload, notes)
    return read


def _drop_unseen(read: Specification, upload: Upload, notes: Notes) -> None:
    """Delete shapes that nobody needs or whose mesh is missing, and tell what bodies lose by it."""
    spec, files = read.spec, []
    missing = provide(spec, upload)
    for geom in list(spec.geoms):
        kind, body = int(geom.type), geom.parent
        touches = bool(geom.contype or geom.conaffinity)
        absent = kind == _MESH and geom.meshname in missing
        if absent and touches:
            read.lost.append(body)
            files.append(missing[geom.meshname])
        weighs = not body.explicitinertial and spec.worldbody is not body
        if absent and weighs and body.name not in read.weightless:
            read.weightless.append(body.name)
        if absent or (kind not in _SHAPES and kind != _PLANE):
            spec.delete(geom)
    used = {geom.meshname for geom in spec.geoms if int(geom.type) == _MESH}
    for mesh in list(spec.meshes):
        if mesh.name not in used:
            spec.delete(mesh)
    if files:
        notes.warn(
            "collision meshes that were not sent or cannot be read (STL, OBJ, DAE, PLY and OFF "
            f"can): {listed(sorted(set(files)))}"
        )
    if read.weightless:
        notes.warn(f"{listed(read.weightless)}: the mass of a mesh that was not sent is missing")


def compile_source(upload: Upload, notes: Notes) -> Source:
    """MuJoCo's model of `upload`.

    Raises:
        InputError: If MuJoCo refuses it or its numbers are out of all bounds.
    """
    read = read_spec(upload, notes)
    spec, own = read.spec, read.own
    try:
        model = spec.compile()
    except (ValueError, RuntimeError) as error:
        why = f"MuJoCo refuses it: {_reason(error)}"
        if read.weightless:
            bodies = listed(read.weightless)
            why = f"send a zip with its meshes: the mass of {bodies} is theirs alone. {why}"
        raise InputError(why, ("file",)) from None
    unseen: dict[int, int] = {}
    for body in read.lost:
        unseen[int(body.id)] = unseen.get(int(body.id), 0) + 1
    _check_numbers(model)
    stem = PurePosixPath(upload.name).stem
    source = Source(
        kind="mjcf" if own is None else "urdf",
        name=(spec.modelname if spec.modelname not in ("", "MuJoCo Model") else stem) or stem,
        model=model,
        data=mujoco.MjData(model),
        limits={} if own is None else own.limits,
        mimics={} if own is None else own.mimics,
        unseen=unseen,
    )
    source.set({})
    if own is not None and own.massless:
        extra = sum(float(model.body(name).mass[0]) for name in own.massless)
        notes.warn(
            f"{listed(own.massless)}: shapes without <inertial>; MuJoCo weighs them as water, "
            f"{extra:.4g} kg of {float(model.body_mass.sum()):.4g} kg, ROS as nothing: as MuJoCo "
            "here; where that is wrong give them an <inertial> of a gram"
        )
    return source


def _check_numbers(model: Any) -> None:
    """Files may hold nan, which MuJoCo compiles."""
    arrays = {
        "pos": (model.body_pos, _LARGEST, "m"), "ipos": (model.body_ipos, _LARGEST, "m"),
        "mass": (model.body_mass, _HEAVIEST, "kg"),
        "inertia": (model.body_inertia, _HEAVIEST, "kg m^2"),
    }  # fmt: skip
    for name, (values, most, unit) in arrays.items():
        bad = ~(np.abs(values) <= most)
        if bad.any():
            body = model.body(int(np.argwhere(bad)[0][0])).name
            text = f"body {body!r}: {name} must be finite and below {most:g} {unit}"
            raise InputError(text, ("file",))
    for name in _FINITE:
        if not np.isfinite(getattr(model, name)).all():
            raise InputError(f"a number is not finite ({name})", ("file",))


def _reason(error: Exception) -> str:
    return " ".join(str(error).split())[:300]
