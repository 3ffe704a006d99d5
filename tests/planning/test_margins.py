"""The CoM margin that plans state is the contract's: found again with shapely and scipy's LP."""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from scipy.optimize import linprog

import stairwright as sw
from stairwright._core import RAY_LIMIT
from stairwright.terrain.stairs import stair

A1S = ("a1_wheeled", "a1_wheeled_x")

TOUCHES = 0.0001  # m; a rim this near to a face touches it truly


def segments(terrain):
    """The faces of `terrain`."""
    return shapely.linestrings(np.stack([terrain.vertices[:-1], terrain.vertices[1:]], axis=1))


def faces_at(terrain, centre, radius):
    """Contact points and normals of a wheel: of the nearest face, and of others truly touched."""
    points, normals = [], []
    gaps = shapely.distance(segments(terrain), shapely.points(centre)) - radius
    for k in np.argsort(gaps):
        if points and gaps[k] > TOUCHES:
            break
        segment = segments(terrain)[k]
        at = np.array(segment.interpolate(segment.project(shapely.points(centre))).coords[0])
        if not any(np.hypot(*(at - p)) < 0.005 for p in points):
            points.append(at)
            normals.append((centre - at) / np.hypot(*(centre - at)))
    return points, normals


def margin(points, normals, friction, x):
    """How far a CoM at `x` may shift with equilibrium inside the cones, the smaller way."""
    columns = []
    for (px, pz), (nx, nz) in zip(points, normals, strict=True):
        for side in (friction, -friction):
            fx, fz = nx + side * nz, nz - side * nx
            columns.append((fx, fz, px * fz - pz * fx))
    rays = np.array(columns).T
    ends = []
    for sign in (1.0, -1.0):
        answer = linprog(sign * rays[2], A_eq=rays[:2], b_eq=[0.0, 1.0], bounds=(0.0, RAY_LIMIT))
        assert answer.status == 0
        ends.append(sign * answer.fun)
    return min(x - ends[0], ends[1] - x)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["path", "critical"])
@pytest.mark.parametrize("robot", A1S)
def test_stated_com_margins_are_those_of_all_friction_cones(robot, method):
    terrain, friction = stair(0.17, 0.29, 2), 0.6
    plan = sw.plan(terrain, robot, friction, method=method)
    assert plan.feasible
    radius = plan.robot_description.wheel.radius
    corners = 0
    for pose in plan.poses:
        wheels = [faces_at(terrain, np.array(centre), radius) for centre in pose.wheels]
        points, normals = (wheels[0][k] + wheels[1][k] for k in range(2))
        mine = margin(points, normals, friction, pose.com[0])
        assert pose.margins.com == pytest.approx(mine, abs=1e-3), pose.progress
        assert math.isfinite(pose.margins.com)
        corners += len(points) > 2
    assert corners >= 2
