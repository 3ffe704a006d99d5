"""How far from the plan's end a robot came to rest."""

from __future__ import annotations

import math

import numpy as np

from stairwright.arrays import Floats
from stairwright.planning.plan import Plan
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import wheel_path

from .disturbance import Disturbance
from .world import course_frame

DRIFT = 0.01  # of the way: what wheels that roll without slip may be off by


def end_error(
    plan: Plan,
    drawn: Terrain,
    real: Terrain,
    deviation: Disturbance,
    wheels: Floats,
    *,
    own_sensors: bool,
) -> float:
    """Largest distance of a wheel from where the plan ends on the real terrain [m].

    Judged along the path: what a deviation makes of the way itself (a start elsewhere, faces
    moved, a wrong measure of length), and where the robot senses by itself the drift of its
    wheels since the last face, is not held against it. It can know where it is on the stairs,
    not in the world. Across the path what counts is the ground that is there.

    Args:
        plan: What was carried out.
        drawn: The terrain as it was believed at the start.
        real: The terrain that was there.
        deviation: How it and the start differ from what the plan believes.
        wheels: (4, 3) centres of the wheels in the world [m].
        own_sensors: Whether the robot had only its own.
    """
    turn, origin = course_frame(deviation, plan.poses[0].x_c)
    x, _, z = (turn.T @ (wheels - origin).T) + origin[:, None]
    if not np.isfinite([x, z]).all():
        return math.inf
    end = np.array(plan.poses[-1].wheels)[[0, 0, 1, 1]]
    start = np.array(plan.poses[0].wheels)[[0, 0, 1, 1]]
    way = np.abs(end[:, 0] - start[:, 0])
    lost = abs(deviation.x_offset) + _faces_moved(drawn, real)
    lost = lost + (abs(deviation.odometry_scale) + 1.0 - math.cos(deviation.heading)) * way
    if own_sensors:
        lost = lost + DRIFT * _since_last_face(plan, end[:, 0])
    off = np.maximum(0.0, np.abs(x - end[:, 0]) - lost)
    path = wheel_path(real, plan.robot_description.wheel.radius)
    places = np.column_stack([np.clip(x, *real.vertices[[0, -1], 0]), z])  # level beyond the ends
    nearest = path.centres(np.array([path.project(place) for place in places]))
    off_ground = np.hypot(*(places - nearest).T)
    return float(np.hypot(off, off_ground).max())


def _faces_moved(drawn: Terrain, real: Terrain) -> float:
    """How far a face is from where it was drawn, at most [m]."""
    there, here = (np.array(t.points)[:, 0] for t in (real, drawn))
    return float(np.abs(there - here).max())


def _since_last_face(plan: Plan, x: Floats) -> Floats:
    """Way from the last steep face before each `x` (n,), or from the start (n,) [m]."""
    vertices, start = plan.terrain.vertices, plan.poses[0].x_c
    dx, dz = np.diff(vertices, axis=0).T
    faces = np.append(vertices[1:, 0][np.abs(dz) > dx], start)
    return np.array([float((at - faces[faces <= at]).min(initial=at - start)) for at in x])
