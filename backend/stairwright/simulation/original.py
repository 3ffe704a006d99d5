"""A robot's own MuJoCo file in our world: its bodies, masses, shapes and joints as they are.

What is ours: the terrain, physics settings and contact sensors, torque motors and their rotors on
the 12 joints, a position servo on each joint that is held (abduction), and a free joint where the
file has none. A wheel whose mesh is missing touches as a ball of the plan's radius. Parts that
overlap as the robot stands do not touch each other: so their shapes are drawn, and so MoveIt takes
them. Nor do parts of a leg that overlap at an end of the knee's range whatever the thigh does.

How joints are mapped: `robot.importing` finds thigh, calf and wheel of each leg by the tree's
shape and says sign and offset of each: ours = sign * theirs + offset, and torques take the same
sign. Of a plan whose rear leads our front left leg is the file's rear right one.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from typing import Any

import mujoco
import numpy as np

from stairwright._core import GRAVITY
from stairwright.arrays import Floats, Ints
from stairwright.errors import InputError
from stairwright.robot.description import LEGS, Robot
from stairwright.robot.importing.assemble import Reading
from stairwright.robot.importing.leg import SideLeg
from stairwright.robot.importing.local import gather
from stairwright.robot.importing.read import read_closely
from stairwright.robot.importing.report import JointMap, Notes
from stairwright.robot.importing.source import read_spec
from stairwright.robot.importing.upload import Upload, unpack
from stairwright.robot.mujoco_model import add_contact_sensors, set_physics, stiffen_contacts
from stairwright.robot.mujoco_terrain import TERRAIN_HALF_WIDTH, add_terrain
from stairwright.robot.turning import OTHER_END, Facing, turned
from stairwright.terrain.profile import Terrain

from .original_shapes import BALLS, add_ball, join_held, overlapping

_FREE = int(mujoco.mjtJoint.mjJNT_FREE)
_ALIKE = 1e-3  # m between the plan's robot and the file's
_GIVES = 0.05  # rad at which an abduction servo gives its full torque
_SERVO_TORQUE = 0.5  # of weight times leg length, where the file has no limit


@dataclass(frozen=True)
class Original:
    """A compiled file in our world, and how its state reads in ours.

    Attributes:
        model: MuJoCo's model.
        maps: Of the 12 joints, in the contract's order.
        positions, speeds: (12,) where these joints are in qpos and qvel.
        base: The trunk's body.
        axes: (3, 3) rows: our axes in those of the trunk's body.
        centre: (3,) the trunk point in the trunk's body [m].
        held: Where abduction and other joints are held: addresses in qpos, and values.
        wheels: (4,) bodies of the wheels.
        planes: (4, 3) the wheels' centres in their bodies [m].
        labels: Of each geom: terrain_0, trunk, FL_thigh ...
    """

    model: Any
    maps: tuple[JointMap, ...]
    positions: Ints
    speeds: Ints
    base: int
    axes: Floats
    centre: Floats
    held: dict[int, float]
    wheels: Ints
    planes: Floats
    labels: list[str]

    def positions_with(self, joints: Floats) -> Floats:
        """The model's qpos with our joints (12,) at these angles [rad], and held ones held."""
        qpos: Floats = self.model.qpos0.copy()
        for address, value in self.held.items():
            qpos[address] = value
        signs, offsets = np.array([(own.sign, own.offset) for own in self.maps]).T
        qpos[self.positions] = signs * (joints - offsets)
        return qpos


def read_original(
    model: str | os.PathLike[str], robot: Robot, facing: Facing = "forward"
) -> tuple[Upload, Reading]:
    """The file `model` (a path, or MJCF or URDF text), which must be `robot`'s.

    Of a backward plan `robot` is turned about, and the reading is not.

    Raises:
        InputError: If it cannot be read, or has other legs than the plan's robot.
    """
    if isinstance(model, str) and model.lstrip().startswith("<"):
        upload = Upload("model.xml", model.encode())
    else:
        name, content, files = gather(model)
        upload = unpack(content, name)
        if files:
            upload = Upload(upload.name, upload.content, files)
    options = {
        "abduction": robot.abduction,
        "wheel_radius": robot.wheel.radius,
        "hold": robot.held_joints,
    }
    try:
        reading, _ = read_closely(upload, options)
    except InputError as error:
        raise InputError(error.message, ("model",)) from None
    built = turned(robot) if facing == "backward" else robot
    for own, other in zip(built.legs, reading.robot.legs, strict=True):
        for what, a, b in (
            ("hips", own.hip, other.hip),
            ("thighs", own.thigh.length, other.thigh.length),
            ("calves", own.calf.length, other.calf.length),
        ):
            if float(np.abs(np.subtract(a, b)).max()) > _ALIKE:
                raise InputError(f"is another robot than the plan's: {what} {b}, not {a}",
                                 ("model",))  # fmt: skip
    return upload, reading


def build_original(
    upload: Upload,
    reading: Reading,
    robot: Robot,
    terrain: Terrain,
    friction: float,
    facing: Facing = "forward",
) -> Original:
    """The file's model on `terrain`, driven as ours is, the end in front that `facing` says.

    Raises:
        InputError: If its trunk can move in some directions only.
    """
    backward = facing == "backward"
    names = [OTHER_END[leg] if backward else leg for leg in LEGS]  # in the reading
    legs = {leg: reading.legs[name] for leg, name in zip(LEGS, names, strict=True)}
    read = read_spec(upload, Notes())
    spec, source = read.spec, reading.source
    bodies, joints = list(spec.bodies), _by_id(spec, source.model)
    base = _base(reading)
    for k, body in enumerate(bodies[1:], 1):
        body.name = body.name or f"body_{k}"
    for k, joint in enumerate(joints):
        joint.name = joint.name or f"joint_{k}"
    for geom in spec.geoms:
        geom.name = ""
    labels = _labels(reading, legs, bodies)
    join_held(spec, reading, bodies, labels)
    _remove_others(spec, bodies, source.model, base)
    _set_free(bodies[source.model.body_rootid[base]])
    set_physics(spec)
    add_terrain(spec, terrain, friction, TERRAIN_HALF_WIDTH)
    for mesh in spec.meshes:
        if mesh.name.startswith("terrain_"):
            mesh.scale = [1.0, 1.0, 1.0]
    for geom in spec.worldbody.geoms:
        geom.conaffinity |= BALLS
    wheels = [int(source.model.jnt_bodyid[leg.chain.wheel]) for leg in legs.values()]
    planes = _planes(reading, names, wheels)
    for leg, wheel, plane in zip(LEGS, wheels, planes, strict=True):
        if any(body is bodies[wheel] for body in read.lost) or not list(bodies[wheel].geoms):
            add_ball(bodies[wheel], plane, robot.wheel.radius)
        labels[bodies[wheel].name] = f"{leg}_wheel"
    chains = [leg.chain for leg in legs.values()]
    driven = [joints[j] for chain in chains for j in (chain.thigh, chain.calf, chain.wheel)]
    _add_motors(spec, robot, driven, [joints[j].name for j in reading.held])
    add_contact_sensors(spec, [bodies[wheel].name for wheel in wheels], bodies[base].name)
    model = spec.compile()
    stiffen_contacts(model, [model.body(bodies[wheel].name).id for wheel in wheels])
    at = [model.joint(joint.name) for joint in driven]
    frame, body = reading.frame, source.data.xmat[base].reshape(3, 3)
    axes = frame.axes @ body
    own = Original(
        model=model,
        maps=tuple(_turned(own) if backward else own for leg in legs.values() for own in leg.maps),
        positions=np.array([int(model.jnt_qposadr[joint.id]) for joint in at]),
        speeds=np.array([int(model.jnt_dofadr[joint.id]) for joint in at]),
        base=model.body(bodies[base].name).id,
        axes=np.diag([-1.0, -1.0, 1.0]) @ axes if backward else axes,
        centre=axes.T @ reading.centre,
        held={
            int(model.jnt_qposadr[model.joint(joints[j].name).id]): value
            for j, value in reading.held.items()
        },
        wheels=np.array([model.body(bodies[wheel].name).id for wheel in wheels]),
        planes=planes,
        labels=[_label(model, geom, labels) for geom in range(model.ngeom)],
    )
    return _apart(spec, own, robot)


def _by_id(spec: Any, model: Any) -> list[Any]:
    """The specification's joints in the model's order."""
    found = [joint for body in spec.bodies for joint in body.joints]
    assert len(found) == model.njnt
    return found


def _base(reading: Reading) -> int:
    """The trunk's body, where `find_frame` took the axes."""
    data = reading.source.data
    places = np.linalg.norm(data.xpos - reading.frame.origin, axis=1)
    model = reading.source.model
    root = model.body_rootid[model.jnt_bodyid[reading.legs["FL"].chain.thigh]]
    for body in range(1, model.nbody):
        if places[body] < 1e-12 and model.body_rootid[body] == root:
            return body
    raise AssertionError("the frame's origin is a body's")


def _turned(own: JointMap) -> JointMap:
    """Of the robot turned about, whose joints turn the other way."""
    return JointMap(name=own.name, sign=-own.sign, offset=-own.offset)


def _labels(reading: Reading, legs: dict[str, SideLeg], bodies: list[Any]) -> dict[str, str]:
    """What each body is part of."""
    model = reading.source.model
    part = {}
    for name, leg in legs.items():
        for what, joint in (
            ("thigh", leg.chain.thigh),
            ("calf", leg.chain.calf),
            ("wheel", leg.chain.wheel),
        ):
            part[int(model.jnt_bodyid[joint])] = f"{name}_{what}"
    found = {}
    for body in range(1, model.nbody):
        above = body
        while above and above not in part:
            above = int(model.body_parentid[above])
        found[bodies[body].name] = part.get(above, "trunk")
    return found


def _apart(spec: Any, own: Original, robot: Robot) -> Original:
    """The same, where parts that are drawn too large do not touch each other."""
    overlaps = overlapping(own.model, own.positions_with, robot)
    if not overlaps:
        return own
    for first, second in overlaps:
        spec.add_exclude(bodyname1=first, bodyname2=second)
    model = spec.compile()
    stiffen_contacts(model, own.wheels.tolist())
    return replace(own, model=model)


def _label(model: Any, geom: int, labels: dict[str, str]) -> str:
    name: str = model.geom(geom).name
    return name or labels.get(model.body(int(model.geom_bodyid[geom])).name, "trunk")


def _remove_others(spec: Any, bodies: list[Any], model: Any, base: int) -> None:
    """Floors, other machines, motors and postures of the file."""
    root = int(model.body_rootid[base])
    for things in (spec.actuators, spec.sensors, spec.keys, spec.pairs):
        for thing in list(things):
            spec.delete(thing)
    for geom in list(spec.worldbody.geoms):
        spec.delete(geom)
    for k, body in enumerate(bodies):
        if k and int(model.body_parentid[k]) == 0 and k != root:
            spec.delete(body)


def _set_free(root: Any) -> None:
    """The whole robot moves freely."""
    own = list(root.joints)
    if not own:
        root.add_freejoint(name="stairwright_root")
    elif int(own[0].type) != _FREE:
        raise InputError(f"{own[0].name!r} holds the trunk; it must be free", ("model",))


def _planes(reading: Reading, names: list[str], wheels: list[int]) -> Floats:
    """(4, 3) the middle of each wheel in its body's frame [m]."""
    data, found = reading.source.data, []
    for name, body in zip(names, wheels, strict=True):
        leg = reading.legs[name]
        own = leg.joints[2].copy()
        own[1] = reading.planes[name]
        place = reading.frame.origin + (leg.axes.T @ own) @ reading.frame.axes
        found.append((place - data.xpos[body]) @ data.xmat[body].reshape(3, 3))
    return np.array(found)


def _add_motors(spec: Any, robot: Robot, driven: list[Any], held: list[str]) -> None:
    """Torque on our 12 joints, first; then a servo on each joint that is held.

    Rotors are the robot's: it has them where the file does, and where URDF has no place for them.
    Wheels without them are so light that the gains, which suit the robot, make them swing.
    """
    for joint, motor in zip(driven, robot.motors, strict=True):
        actuator = _actuator(spec, joint.name)
        actuator.set_to_motor()
        actuator.ctrllimited, actuator.ctrlrange = True, [-motor.torque, motor.torque]
        joint.armature = motor.armature
    plenty = _SERVO_TORQUE * robot.mass * GRAVITY * min(leg.reach for leg in robot.legs)
    for name in held:
        actuator = _actuator(spec, name)
        stiffness = plenty / _GIVES
        actuator.set_to_position(kp=stiffness, kv=0.05 * stiffness)
        actuator.ctrllimited = False
        actuator.forcelimited, actuator.forcerange = True, [-plenty, plenty]


def _actuator(spec: Any, joint: str) -> Any:
    actuator = spec.add_actuator(
        name=f"stairwright_{joint}", target=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT
    )
    actuator.gear = [1.0, 0, 0, 0, 0, 0]
    actuator.forcelimited = False
    return actuator
