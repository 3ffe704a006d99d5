"""Static forces along a plan: they hold the robot, inside the cones, and no larger than needed."""

from __future__ import annotations

import math

import numpy as np
import pytest

from stairwright import _core
from stairwright.control.contact import BEFORE, support
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import WheelPath, wheel_path

WEIGHT, RADIUS = 116.0, 0.05


def resting(path: WheelPath, places, com, friction: float = 0.6):
    out = _core.static_forces(path.native, WEIGHT, friction, np.array(places), np.array(com))
    return out[:, :4].reshape(-1, 2, 2)


def path_of(*points: tuple[float, float]) -> WheelPath:
    return wheel_path(Terrain(points=list(points)), RADIUS)


@pytest.mark.parametrize("share", [0.2, 0.5, 0.9])
def test_level_ground_carries_by_levers_without_traction(share: float) -> None:
    path = path_of((-1.0, 0.0), (1.0, 0.0))
    front, rear = path.at_x(0.2), path.at_x(-0.2)
    found = resting(path, [(front, rear)], [(-0.2 + 0.4 * share, 0.3)])[0]
    np.testing.assert_allclose(found[:, 1], [share * WEIGHT, (1 - share) * WEIGHT], rtol=0.01)
    np.testing.assert_allclose(found[:, 0], 0.0, atol=0.5)


@pytest.mark.parametrize("front_z", [0.08, 0.15, 0.25])
def test_climbing_forces_hold_the_weight_inside_the_cones(front_z: float) -> None:
    path = path_of((-1.0, 0.0), (0.0, 0.0), (0.0, 0.36), (1.0, 0.36))
    corner = float(path.corners[0])
    front, rear = corner + front_z - RADIUS, corner - 0.35
    com = np.array([-0.25, front_z + 0.15])
    found = resting(path, [(front, rear)], [com])[0]
    np.testing.assert_allclose(found.sum(axis=0), [0.0, WEIGHT], atol=0.02 * WEIGHT)
    points = path.contacts(np.array([front, rear]))
    lever = points - com
    moment = lever[:, 1] * found[:, 0] - lever[:, 0] * found[:, 1]
    assert abs(moment.sum()) < 0.01 * WEIGHT
    normals = path.normals(np.array([front, rear]))
    tangents = np.stack([normals[:, 1], -normals[:, 0]], axis=1)
    along, across = (found * tangents).sum(axis=1), (found * normals).sum(axis=1)
    assert (np.abs(along) <= 0.6 * across + 1e-6).all()


def test_wheels_on_a_curbs_two_faces_do_not_pinch() -> None:
    """Front wheels hang on the far face, rear wheels on the near one: friction must carry all."""
    path = path_of((-1.0, 0.0), (0.0, 0.0), (0.0, 0.4), (0.3, 0.4), (0.3, 0.0), (1.3, 0.0))
    near, far = path.corners
    found = resting(path, [(far - 0.2, near + 0.2)], [(0.15, 0.45)])[0]
    np.testing.assert_allclose(found.sum(axis=0), [0.0, WEIGHT], atol=0.02 * WEIGHT)
    # Half the weight hangs on each face: with 3/4 of the friction, pushed no harder than that asks.
    assert np.hypot(*found[0]) < 1.05 * math.hypot(1.0, 1 / 0.45) * WEIGHT / 2


def test_forces_are_continuous_into_a_corner() -> None:
    path = path_of((-1.0, 0.0), (0.0, 0.0), (0.0, 0.36), (1.0, 0.36))
    corner = float(path.corners[0])
    way = np.linspace(-0.007, 0.0028, 29)
    places = [(corner + d, corner - 0.35) for d in way]
    found = resting(path, places, [(-0.25, 0.3)] * len(places))
    assert np.abs(np.diff(found, axis=0)).max() < 0.05 * WEIGHT


def within_cone(forces, normal: tuple[float, float], friction: float = 0.6):
    across = forces @ np.array(normal)
    return np.abs(forces @ np.array([normal[1], -normal[0]])) <= friction * across + 0.01 * WEIGHT


@pytest.mark.parametrize("past", [0.008, 0.012])
def test_round_an_edge_forces_leave_room_for_where_the_wheel_may_be(past: float) -> None:
    path = path_of((-1.0, 0.0), (0.0, 0.0), (0.0, 0.2), (1.0, 0.2))
    front, rear = float(path.corners[0]) + 0.15 + past, path.at_x(-0.3)  # the arc begins there
    force = resting(path, [(front, rear)], [(-0.2, 0.3)])[0, 0]
    for normal in path.normals(np.array([front - 0.003, front, front + 0.003])):
        along = abs(force @ np.array([normal[1], -normal[0]]))
        assert along < 0.4 * (force @ normal)


def test_a_wheel_on_its_way_down_hangs_on_its_face_until_it_is_down() -> None:
    """Standing on the floor takes smaller forces, but the floor is 2 mm farther down."""
    path = path_of((-1.0, 0.0), (0.0, 0.0), (0.0, -0.3), (1.0, -0.3))
    corner = float(path.corners[0])
    front, rear = corner - 0.002, path.at_x(-0.3)
    found = resting(path, [(front, rear), (corner, rear)], [(-0.25, 0.1)] * 2)[:, 0]
    assert within_cone(found[:1], (1.0, 0.0)).all()
    assert within_cone(found[1:], (0.0, 1.0)).all()


def test_more_friction_is_used_where_wheels_would_press_far_harder_without() -> None:
    """Rear wheels high on a wall, front wheels on its top: with little friction they would have to
    push the robot down."""
    radius = 0.18
    points = [(-3.67, 0.0), (0.0, 0.0), (0.0, 1.2337), (3.67, 1.2337)]
    path = wheel_path(Terrain(points=points), radius)
    found = resting(path, [(4.9708, 4.0809)], [(-0.029, 1.912)])[0]
    np.testing.assert_allclose(found.sum(axis=0), [0.0, WEIGHT], atol=0.02 * WEIGHT)
    assert found[1, 1] > 0.1 * WEIGHT
    assert np.hypot(*found.T).sum() < 1.35 * WEIGHT


def test_small_wheels_lean_on_a_corner_only_near_it() -> None:
    out = np.zeros(8)
    points = [(-1.0, 0.0), (0.0, 0.0), (0.0, 0.3), (1.0, 0.3)]
    for radius, face in ((0.05, (0.0, 1.0)), (0.025, (-1.0, 0.0))):
        path = wheel_path(Terrain(points=points), radius)
        beyond = float(path.corners[0]) + 0.006
        support(path, beyond, beyond, 0.6, BEFORE, out)
        np.testing.assert_allclose(out[:2], face, atol=1e-9)


def test_a_wheel_past_a_corner_climbs() -> None:
    """Standing on the tread takes smaller forces, but the plan has the wheel 4 mm up."""
    path = path_of((-1.0, 0.0), (0.0, 0.0), (0.0, 0.06), (1.0, 0.06))
    corner = float(path.corners[0])
    front, rear = path.at_x(0.3), corner + 0.004
    found = resting(path, [(front, rear)], [(0.25, 0.3)])[0]
    assert within_cone(found[1], (-1.0, 0.0))
    assert found[1, 0] < -0.1 * WEIGHT
    np.testing.assert_allclose(found.sum(axis=0), [0.0, WEIGHT], atol=0.02 * WEIGHT)
