import numpy as np
import pytest

import stairwright as sw
from stairwright import _core
from stairwright.planning.poses.terrain_window import cell_vector, cells, curve_window
from stairwright.robot.kinematics import limits
from stairwright.terrain.profile import height_at
from stairwright.terrain.wheel_path import wheel_path
from tests.planning.drawn import random_profile
from tests.shapely_checker import check


@pytest.mark.parametrize("seed", range(20))
def test_clearance_equals_shapely(seed):
    robot, terrain = sw.load_robot("a1_wheeled"), random_profile(seed)
    ground = _core.Terrain(terrain.vertices)
    random = np.random.default_rng(seed)
    low, high = limits(robot).T
    for _ in range(10):
        x = random.uniform(-0.5, terrain.points[-1][0] - 0.5)
        trunk = (x, terrain.height(x) + random.uniform(0.0, 0.5), random.uniform(-1.5, 1.5))
        q = random.uniform(low, high)
        verdict = check(robot, terrain.vertices, *trunk, q)
        gap = _core.least_clearance(ground, robot.native, np.array(trunk), q)
        if verdict.clearance > 0:
            assert gap == pytest.approx(min(verdict.clearance, 0.5), abs=1e-9)
        else:
            assert gap == pytest.approx(verdict.clearance, abs=4e-3)
        if verdict.legs_apart > 0:
            distance = _core.legs_distance(robot.native, np.array(trunk), q)
            assert distance == pytest.approx(verdict.legs_apart, abs=1e-9)


@pytest.mark.parametrize("x", [-2.0, 3.0])
def test_the_ground_goes_on_level_beyond_its_ends(x):
    """As in simulation: a knee that hangs over the end of the drawing touches it."""
    robot, terrain = sw.load_robot("a1_wheeled"), sw.Terrain(points=[(-2.0, 0.1), (3.0, 0.1)])
    q = np.array([0.9, -1.8, 0.9, -1.8])
    high = [
        _core.least_clearance(_core.Terrain(each), robot.native, np.array([x, 0.3, 0.0]), q)
        for each in (terrain.vertices, np.array([[-5.0, 0.1], [5.0, 0.1]]))
    ]
    assert high[0] == high[1] < 0.2


@pytest.mark.parametrize("seed", range(20))
def test_cells_are_the_ground(seed):
    """A point lies in some convex cell exactly where it is below the profile."""
    terrain = random_profile(seed)
    span = (0.0, 1.2)
    normals, offsets, corners = cell_vector(cells(terrain.vertices, *span))
    random = np.random.default_rng(seed)
    x = random.uniform(*span, 500)
    height = height_at(terrain.vertices, x)
    points = np.stack([x, height + random.uniform(-0.3, 0.3, 500)], axis=1)
    inside = np.any(np.all(points @ normals.transpose(0, 2, 1) <= offsets[:, None], axis=2), axis=0)
    below = points[:, 1] < height
    assert np.array_equal(inside, below) or np.all(inside[below])
    # Every corner belongs to its cell.
    for n, d, c in zip(normals, offsets, corners, strict=True):
        assert np.all(n @ c.T <= d[:, None] + 1e-9)


def test_windows_follow_the_curve():
    path = wheel_path(random_profile(3), 0.05)
    for s in np.linspace(0, path.length, 30):
        rows, low, high = curve_window(path, float(s))
        assert low - 1e-9 <= s <= high + 1e-9
        assert rows[-1, :2] == pytest.approx(path.centres(np.array([low]))[0])
