"""The world that a rollout takes place in: terrain and robot with their deviations."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import Any

import mujoco
import numpy as np

from stairwright.arrays import Floats
from stairwright.robot.description import LEGS, Robot
from stairwright.robot.mujoco_model import build_spec, stiffen_contacts
from stairwright.robot.mujoco_terrain import TERRAIN_HALF_WIDTH
from stairwright.terrain.profile import Terrain

from .disturbance import Disturbance

_LEAST_FRICTION = 0.01
_FACE_SLOPE = 1.0  # a stretch that is steeper (45 degrees) is a face, else a tread
_PAYLOAD_ABOVE = 0.05  # m, mass centre of the payload above the top of the trunk's middle
_MOST_DEVIATIONS = 2.0  # standard deviations
_TERRAIN_STREAM = 1  # of the seed's random numbers: those of the terrain's errors


def build_world(
    robot: Robot, terrain: Terrain, friction: float, deviation: Disturbance, pivot: float
) -> Any:
    """The compiled model of `robot` on the real `terrain`.

    Args:
        robot: As the plan knows it.
        terrain: The real one, see `real_terrain`.
        friction: Coulomb friction before deviations.
        deviation: What is different.
        pivot: Abscissa about which the terrain is turned by the heading [m].
    """
    friction += deviation.friction
    half_width = TERRAIN_HALF_WIDTH
    if deviation.heading != 0.0:  # the robot drifts off the middle
        half_width += abs(math.tan(deviation.heading)) * float(np.ptp(terrain.vertices[:, 0]))
    ground = max(_LEAST_FRICTION, friction)
    spec = build_spec(robot, terrain, ground, half_width=half_width, visual=False)
    _turn_terrain(spec, deviation, pivot)
    for leg in LEGS:
        own = friction + (deviation.friction_front if leg[0] == "F" else deviation.friction_rear)
        if deviation.friction_wheels is not None:
            own = deviation.friction_wheels[LEGS.index(leg)]
        if own != friction:
            wheel = spec.geom(f"{leg}_wheel")
            wheel.priority = 2  # over the terrain's
            wheel.friction = [max(_LEAST_FRICTION, own), 0.0, 0.0]
    _disturb_motors(spec, deviation)
    disturb_trunk(spec, robot, deviation)
    model = spec.compile()
    stiffen_contacts(model, [model.body(f"{leg}_wheel").id for leg in LEGS])
    return model


def _disturb_motors(spec: Any, deviation: Disturbance) -> None:
    for leg in LEGS:
        for part in ("thigh", "calf", "wheel"):
            joint = spec.joint(f"{leg}_{part}")
            joint.frictionloss += deviation.stiction
            if deviation.rotor_inertia is not None:
                joint.armature = deviation.rotor_inertia


def course_frame(deviation: Disturbance, pivot: float) -> tuple[Floats, Floats]:
    """Rotation (3, 3) and origin (3,) of the terrain's frame in the world: p = R (q - o) + o.

    The robot starts along the world's x axis; what is oblique is the terrain.
    """
    yaw, roll = -deviation.heading, deviation.cross_slope
    c, s = math.cos(yaw), math.sin(yaw)
    turned = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    c, s = math.cos(roll), math.sin(roll)
    tilted = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    return turned @ tilted, np.array([pivot, 0.0, 0.0])


def _turn_terrain(spec: Any, deviation: Disturbance, pivot: float) -> None:
    if deviation.heading == 0.0 and deviation.cross_slope == 0.0:
        return
    turn, origin = course_frame(deviation, pivot)
    quaternion = np.zeros(4)
    mujoco.mju_mat2Quat(quaternion, turn.ravel())
    for geom in spec.geoms:
        if geom.name.startswith("terrain"):
            geom.pos = turn @ (np.array(geom.pos) - origin) + origin
            geom.quat = quaternion


def real_terrain(terrain: Terrain, deviation: Disturbance, seed: int) -> Terrain:
    """The terrain with its rise and its single steps and faces off as the deviation says.

    The start's tread stays where it is: heights count from there.
    """
    points = np.array(terrain.points)
    x, z = points.T.copy()
    rise = float(np.ptp(z))
    if deviation.height != 0.0 and rise >= 1e-6:
        z = z[0] + max(0.0, 1.0 + deviation.height / rise) * (z - z[0])
    if deviation.step_height_error or deviation.face_place_error:
        random = np.random.default_rng([seed, _TERRAIN_STREAM])
        x, z = _with_errors(x, z, deviation, random)
    if np.array_equal(np.column_stack([x, z]), points):
        return terrain
    return Terrain(
        name=terrain.name,
        points=list(zip(x.tolist(), z.tolist(), strict=True)),
        friction=terrain.friction,
        start=terrain.start,
        goal=terrain.goal,
    )


def _with_errors(
    x: Floats, z: Floats, deviation: Disturbance, random: np.random.Generator
) -> tuple[Floats, Floats]:
    """Abscissas and heights with every face moved and every rise off, each by its own error.

    Runs of steep stretches are a face, runs of others a tread. Faces keep their slope, treads
    theirs; a face's height error lifts all that lies behind it.
    """
    dx, dz = np.diff(x), np.diff(z)
    steep = np.abs(dz) > _FACE_SLOPE * dx
    moved, lifted = np.zeros(len(x)), np.zeros(len(x))
    heights = _errors(deviation.step_height_error, len(x), random)
    places = _errors(deviation.face_place_error, len(x), random)
    level = at = 0.0
    before = -np.inf  # where the tread begins
    stretch = 0
    for is_face, run in itertools.groupby(steep):
        first, stretch = stretch, stretch + len(list(run))
        if not is_face:
            lifted[first : stretch + 1] = level
            before = x[first] + at
            continue
        wanted = next(places)
        # A face does not reach past the ends of the treads beside it.
        following = np.flatnonzero(steep[stretch:])
        after = x[stretch + following[0]] if len(following) else x[-1]
        room = (0.4 * (x[first] - before), 0.4 * (after - x[stretch]))
        at = float(np.clip(wanted, -max(room[0], 0.0), max(room[1], 0.0)))
        level += next(heights)
        moved[first : stretch + 1] = at
        shares = np.linspace(0.0, 1.0, stretch + 1 - first)
        old = lifted[first]
        lifted[first : stretch + 1] = old + shares * (level - old)
    moved[0] = moved[-1] = 0.0
    return np.maximum.accumulate(x + moved), z + lifted


def _errors(given: float | list[float], most: int, random: np.random.Generator) -> Iterator[float]:
    """One error after the other: those given, or normal ones, cut at two standard deviations."""
    if isinstance(given, list):
        return itertools.chain(given, itertools.repeat(0.0))
    drawn = np.clip(random.standard_normal(most), -_MOST_DEVIATIONS, _MOST_DEVIATIONS)
    return iter((given * drawn).tolist())


def disturb_trunk(spec: Any, robot: Robot, disturbance: Disturbance) -> None:
    """Change the trunk of an uncompiled model: mass, payload, and where its mass centre is."""
    trunk, body = spec.body("trunk"), robot.body
    mass = max(0.1, body.mass + disturbance.mass * robot.mass)
    inertia = np.array(body.inertia) * mass / body.mass
    added = disturbance.load.mass
    middle, top = body.top(0.0)
    place = np.array(disturbance.load.place or (middle, 0.0, top + _PAYLOAD_ABOVE))
    com = (mass * np.array(body.com) + added * place) / (mass + added)
    for part, at in ((mass, np.array(body.com)), (added, place)):
        arm = at - com
        inertia = inertia + part * (arm @ arm - arm**2)
    mass += added
    total = robot.mass - body.mass + mass
    trunk.mass, trunk.inertia = mass, inertia
    trunk.ipos = com + np.array([disturbance.com_x, 0.0, disturbance.com_z]) * total / mass
