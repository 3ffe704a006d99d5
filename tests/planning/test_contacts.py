"""CoM intervals of wheels in corners and on edges."""

import math

import numpy as np
import pytest

from stairwright._core import com_intervals, pair_interval, steady_interval
from stairwright.terrain.stairs import stair
from stairwright.terrain.wheel_path import wheel_path

RADIUS, FRICTION = 0.05, 0.5
PATH = wheel_path(stair(0.2, 0.3, 2), RADIUS)
STRAY = 0.005  # m


def interval(front, rear, cap=1.0):
    return pair_interval(PATH.native, front, rear, FRICTION, cap)


def all_faces(front, rear):
    """What friction on every touching face could hold."""
    return com_intervals(PATH.native, np.array([[front, rear]]), FRICTION)[0]


def test_level_ground_carries_between_the_wheels():
    x = [PATH.centres(np.array([s]))[0, 0] for s in (0.9, 0.6)]
    assert interval(0.9, 0.6) == pytest.approx((x[1], x[0]))


def test_no_plan_counts_on_friction_of_both_faces_of_a_corner():
    """The front wheel in the second corner, the rear one on the level before the first."""
    corner = PATH.corners[1]
    x = PATH.centres(np.array([corner]))[0, 0]
    low, high = interval(corner, PATH.corners[0] - 0.05)
    wedged = all_faces(corner, PATH.corners[0] - 0.05)
    assert high < x + 0.005 < x + 0.02 < wedged[1]
    assert low == pytest.approx(wedged[0], abs=0.02)


def test_either_face_of_a_corner_may_carry_alone():
    """What holds with the wheel on one face just outside the corner holds in it."""
    corner, rear = PATH.corners[1], PATH.corners[0] - 0.05
    low, high = interval(corner, rear)
    for beside in (-0.004, 0.004):
        one = interval(corner + beside, rear)
        if one[0] <= one[1]:
            assert low <= one[0] + 0.005
            assert high >= one[1] - 0.005


def test_no_more_than_all_faces_together():
    rng = np.random.default_rng(1)
    for _ in range(300):
        corner = rng.choice(PATH.corners)
        front = corner + rng.uniform(-0.002, 0.002)
        rear = front - rng.uniform(0.2, 0.5)
        low, high = interval(front, rear)
        most = all_faces(front, rear)
        assert low > high or (low >= most[0] - 1e-9 and high <= most[1] + 1e-9)


def test_on_an_edge_a_wheel_may_stray():
    """Half round the first edge, the rear wheel on the level before the stair."""
    edge = PATH.corners[0] + 0.2 - RADIUS + 0.6 * RADIUS * math.pi / 2
    rear = PATH.corners[0] - 0.05
    steady = steady_interval(PATH.native, edge, rear, FRICTION)
    assert steady[0] < steady[1]
    for stray in (-STRAY, 0.0, STRAY):
        low, high = interval(edge + stray, rear, cap=0.75)
        assert low <= steady[0] + 1e-12
        assert high >= steady[1] - 1e-12
    assert steady != interval(edge, rear, cap=0.75)


def test_on_level_ground_straying_changes_nothing():
    assert steady_interval(PATH.native, 0.9, 0.6, FRICTION) == interval(0.9, 0.6, cap=0.75)
