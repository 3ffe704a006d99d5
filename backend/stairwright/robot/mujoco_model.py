"""The MuJoCo model of a robot on a terrain, generated from the same documents as everything else.

Settings that the tests prove (`tests/robot/test_mujoco_model.py`): 1 ms, implicitfast, Newton with
a dense Jacobian, elliptic friction cones, multi-contact CCD off. A wheel collides as a sphere: the
terrain is extruded along y, so a sphere touches it exactly where the wheel's circle does, while
cylinders get false upward contacts at box edges. What one sees is a cylinder with spokes.

Who touches whom: everything touches the terrain; links and wheels of a front leg touch those of the
rear leg on the same side; legs pass the trunk freely, because they move beside it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np

from stairwright._core import GRAVITY
from stairwright.arguments import as_friction
from stairwright.terrain.profile import Terrain

from .description import JOINTS, LEGS, Robot
from .legs import LinkForm
from .mujoco_terrain import GROUND, TERRAIN_HALF_WIDTH, add_terrain
from .parts import Actuator, Outline

TIMESTEP = 0.001  # s
_DEFAULT_CONTACT = (0.02, 0.95)  # MuJoCo's: time constant [s], impedance
_MOST_CREEP = 0.025  # m/s of a wheel whose traction is all that it carries

# Collision bits: a pair touches when contype of one meets conaffinity of the other.
_LEFT, _RIGHT = 2, 4  # beside the terrain's, `GROUND`
_BITS = {  # contype, conaffinity
    "trunk": (0, GROUND),
    "FL": (_LEFT, GROUND),
    "RL": (0, GROUND | _LEFT),
    "FR": (_RIGHT, GROUND),
    "RR": (0, GROUND | _RIGHT),
}
_COLLISION_GROUP, _VISUAL_GROUP = 3, 2
# Contact sensor of a wheel: how many contacts with the world, and their net force *on the world*.
_WHEEL_SENSOR = [
    (1 << int(mujoco.mjtConDataField.mjCONDATA_FOUND))
    | (1 << int(mujoco.mjtConDataField.mjCONDATA_FORCE)),
    3,  # reduce: net force, in world axes
    1,
]
# Contact sensor of the whole robot: how many contacts, with the world or with itself.
_COUNT_SENSOR = [1 << int(mujoco.mjtConDataField.mjCONDATA_FOUND), 0, 1]
_COLOURS = {
    "trunk": (0.16, 0.22, 0.32, 1.0),
    "thigh": (0.90, 0.55, 0.15, 1.0),
    "calf": (0.75, 0.78, 0.82, 1.0),
    "wheel": (0.10, 0.10, 0.12, 1.0),
    "spoke": (0.85, 0.85, 0.85, 1.0),
}


def build_spec(
    robot: Robot,
    terrain: Terrain | None = None,
    friction: float | None = None,
    *,
    half_width: float = TERRAIN_HALF_WIDTH,
    visual: bool = True,
) -> Any:
    """An editable `mujoco.MjSpec` of `robot` standing free on `terrain`.

    Args:
        robot: The robot's description.
        terrain: The ground as extruded convex prisms; None leaves the world empty.
        friction: Coulomb friction of every contact; the terrain's own by default.
        half_width: Half the terrain's extent along y [m].
        visual: Add what is only seen (wheel discs and spokes).
    """
    spec = mujoco.MjSpec()
    spec.modelname = robot.name
    spec.compiler.degree = False
    set_physics(spec)
    if friction is None:
        friction = terrain.friction if terrain is not None else 1.0
    friction = as_friction(friction)
    if terrain is not None:
        add_terrain(spec, terrain, friction, half_width)
    spec.worldbody.add_light(pos=[0, -2, 4], dir=[0, 0.5, -1])
    _add_robot(spec, robot, friction, visual)
    return spec


def set_physics(spec: Any) -> None:
    """The settings that the tests prove."""
    option = spec.option
    option.timestep = TIMESTEP
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.solver = mujoco.mjtSolver.mjSOL_NEWTON
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_MULTICCD


def stiffen_contacts(model: Any, wheels: Sequence[int]) -> None:
    """Make a compiled model's contacts stiffer where wheels would creep and sink as no tyre does.

    MuJoCo's contacts are as soft as the bodies in them are light, whatever these carry: with
    impedance d, time constant t and inverse mass A, a force F makes a wheel creep by
    (1 - d) t A F / 2 (its documentation, "Solver parameters"). Of the presets none does so by more
    than 25 mm/s under its quarter of the weight; one of 92 kg whose calves and wheels weigh 0.7 kg
    did by 74 mm/s.

    Args:
        model: An `mujoco.MjModel`.
        wheels: Bodies of the wheels.
    """
    load = GRAVITY * float(model.body_mass.sum()) / len(wheels)
    inverse_mass = float(model.body_invweight0[list(wheels), 0].max())
    time_constant, impedance = _DEFAULT_CONTACT
    creep = 0.5 * (1.0 - impedance) * time_constant * inverse_mass * load
    if creep > _MOST_CREEP:
        softness = 1.0 - model.geom_solimp[:, :2]
        model.geom_solimp[:, :2] = 1.0 - softness * _MOST_CREEP / creep


def add_contact_sensors(spec: Any, wheels: Sequence[str], trunk: str) -> None:
    """What the world does to each wheel's body, and how many contacts the robot has."""
    for leg, wheel in zip(LEGS, wheels, strict=True):
        spec.add_sensor(
            name=f"{leg}_contact",
            type=mujoco.mjtSensor.mjSENS_CONTACT,
            objtype=mujoco.mjtObj.mjOBJ_BODY,
            objname=wheel,
            reftype=mujoco.mjtObj.mjOBJ_BODY,
            refname="world",
            intprm=_WHEEL_SENSOR,
        )
    spec.add_sensor(
        name="all_contacts",
        type=mujoco.mjtSensor.mjSENS_CONTACT,
        objtype=mujoco.mjtObj.mjOBJ_XBODY,
        objname=trunk,
        intprm=_COUNT_SENSOR,
    )


def build_model(
    robot: Robot,
    terrain: Terrain | None = None,
    friction: float | None = None,
    *,
    half_width: float = TERRAIN_HALF_WIDTH,
    visual: bool = False,
) -> Any:
    """The compiled `mujoco.MjModel` of `build_spec`, contacts as stiff as in rollouts."""
    spec = build_spec(robot, terrain, friction, half_width=half_width, visual=visual)
    model = spec.compile()
    stiffen_contacts(model, [model.body(f"{leg}_wheel").id for leg in LEGS])
    return model


def _add_robot(spec: Any, robot: Robot, friction: float, visual: bool) -> None:
    trunk = spec.worldbody.add_body(name="trunk", pos=[0, 0, robot.nominal_height])
    trunk.add_freejoint(name="root")
    body = robot.body
    _set_inertial(trunk, body.mass, body.com, body.inertia)
    for k, piece in enumerate(body.outline):
        name = f"trunk_{k}" if k else "trunk"
        trunk.add_geom(
            name=name, **_piece(spec, name, piece), **_surface("trunk", "trunk", friction)
        )
    trunk.add_site(name="imu")
    for leg in LEGS:
        _add_leg(trunk, robot, leg, friction, visual)
    for joint, motor in zip(JOINTS, robot.motors, strict=True):
        actuator = spec.add_actuator(
            name=joint,
            target=joint,
            trntype=mujoco.mjtTrn.mjTRN_JOINT,
            gaintype=mujoco.mjtGain.mjGAIN_FIXED,
            biastype=mujoco.mjtBias.mjBIAS_NONE,
            ctrllimited=True,
            ctrlrange=[-motor.torque, motor.torque],
        )
        actuator.gainprm[0] = 1.0
    add_contact_sensors(spec, [f"{leg}_wheel" for leg in LEGS], "trunk")


def _piece(spec: Any, name: str, piece: Outline) -> dict[str, Any]:
    """A piece of the trunk: a box where it is one, else a mesh."""
    points = np.array(piece.points)
    low, high = points.min(axis=0), points.max(axis=0)
    (x, z), (length, height) = (low + high) / 2, high - low
    if len(points) == 4 and np.all((points == low) | (points == high)):
        size = [length / 2, piece.width / 2, height / 2]
        return {"type": mujoco.mjtGeom.mjGEOM_BOX, "size": size, "pos": [x, 0.0, z]}
    mesh = spec.add_mesh(name=f"{name}_mesh")
    half = piece.width / 2
    mesh.uservert = np.array([(a, y, b) for y in (-half, half) for a, b in points]).ravel()
    return {"type": mujoco.mjtGeom.mjGEOM_MESH, "meshname": mesh.name}


def _add_leg(trunk: Any, robot: Robot, leg: str, friction: float, visual: bool) -> None:
    own = robot.legs[0 if leg[0] == "F" else 1]
    side = 1.0 if leg[1] == "L" else -1.0
    parent, place = trunk, [own.hip[0], side * robot.hips.half_track, own.hip[1]]
    for part in ("thigh", "calf"):
        link: LinkForm = getattr(own, part)
        body = parent.add_body(name=f"{leg}_{part}", pos=place)
        _add_hinge(body, f"{leg}_{part}", getattr(own, f"{part}_motor"), getattr(own.limits, part))
        _set_inertial(body, link.mass, (link.com[0], 0.0, link.com[1]), link.inertia)
        for k, ((ax, az), (bx, bz), radius) in enumerate(link.capsules):
            body.add_geom(
                name=f"{leg}_{part}_{k}" if k else f"{leg}_{part}",
                type=mujoco.mjtGeom.mjGEOM_CAPSULE,
                fromto=[ax, 0, az, bx, 0, bz],
                size=[radius, 0, 0],
                **_surface(leg, part, friction),
            )
        parent, place = body, [0.0, 0.0, -link.length]
    wheel = parent.add_body(name=f"{leg}_wheel", pos=place)
    _add_hinge(wheel, f"{leg}_wheel", own.wheel_motor, None)
    # Rolling resistance as a torque in the bearing, at the load of a robot that stands on four.
    drag = own.wheel.rolling_resistance * robot.mass * GRAVITY / 4 * own.wheel.radius
    wheel.joints[0].frictionloss = drag
    _set_inertial(wheel, own.wheel.mass, (0.0, 0.0, 0.0), own.wheel.inertia)
    surface = _surface(leg, "wheel", friction)
    if visual:
        surface["rgba"] = (0.0, 0.0, 0.0, 0.0)
        _add_wheel_look(wheel, leg, robot)
    wheel.add_geom(
        name=f"{leg}_wheel",
        type=mujoco.mjtGeom.mjGEOM_SPHERE,
        size=[robot.wheel.radius, 0, 0],
        **surface,
    )


def _add_hinge(body: Any, name: str, motor: Actuator, limits: tuple[float, float] | None) -> None:
    joint = body.add_joint(
        name=name,
        type=mujoco.mjtJoint.mjJNT_HINGE,
        axis=[0, 1, 0],
        armature=motor.armature,
        damping=motor.damping,
    )
    if limits is not None:
        joint.limited = True
        joint.range = limits


def _add_wheel_look(wheel: Any, leg: str, robot: Robot) -> None:
    """A disc and three spokes, which show that the wheel turns; they touch nothing."""
    look = {"contype": 0, "conaffinity": 0, "group": _VISUAL_GROUP, "mass": 0.0}
    width = robot.wheel.width / 2
    wheel.add_geom(
        name=f"{leg}_disc",
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        fromto=[0, -width, 0, 0, width, 0],
        size=[robot.wheel.radius, 0, 0],
        rgba=_COLOURS["wheel"],
        **look,
    )
    for k in range(3):
        angle = math.pi * k / 3
        wheel.add_geom(
            name=f"{leg}_spoke_{k}",
            type=mujoco.mjtGeom.mjGEOM_BOX,
            size=[0.85 * robot.wheel.radius, width + 0.001, 0.003],
            quat=[math.cos(angle / 2), 0, math.sin(angle / 2), 0],
            rgba=_COLOURS["spoke"],
            **look,
        )


def _set_inertial(
    body: Any, mass: float, centre: tuple[float, float, float], inertia: tuple[float, ...]
) -> None:
    body.explicitinertial = True
    body.mass, body.ipos, body.inertia = mass, centre, inertia


def _surface(owner: str, part: str, friction: float) -> dict[str, Any]:
    contype, conaffinity = _BITS[owner]
    return {
        "contype": contype,
        "conaffinity": conaffinity,
        "condim": 3,
        "friction": [friction, 0.0, 0.0],
        "group": _COLLISION_GROUP if part == "wheel" else 0,
        "rgba": _COLOURS[part],
    }
