"""The native solver and the plain CasADi form find the same optimum of the same problem."""

import numpy as np
import pytest

import stairwright as sw
from stairwright import _core
from stairwright.planning.casadi_search import CasadiSearch
from stairwright.planning.nlp import Layout
from stairwright.planning.pose_locations import find_obstacles
from stairwright.planning.pose_search import ContactPair, PoseSearch
from stairwright.planning.solver import Bounds, pose_solver
from stairwright.planning.weights import CriticalWeights
from stairwright.robot.symbolic import dimensions
from stairwright.terrain.wheel_path import wheel_path
from tests.planning.drawn import random_profile
from tests.shapely_checker import check

A1S = ("a1_wheeled", "a1_wheeled_x")


def both(seed, links, count=6):
    """Pairs of solutions (ours: x, cost, violation; CasADi's) of random problems."""
    random = np.random.default_rng(seed)
    robot = sw.load_robot(A1S[seed % 2])
    path = wheel_path(random_profile(seed), robot.wheel.radius)
    search = CasadiSearch(robot, path, 0.6, CriticalWeights())
    points = robot.collision_points
    layout = Layout(tuple(points.trunk), tuple(points.thigh), tuple(points.calf))
    rules = search.rules
    for _ in range(count):
        front = random.uniform(0.8, path.length - 0.1)
        rear = front - random.uniform(0.2, 0.45)
        lower, upper = rules.lower.copy(), rules.upper.copy()
        lower[7] = upper[7] = front
        lower[8], upper[8] = rear - 0.025, rear + 0.025
        wanted = search.reference(float(path.centres(np.array([front, rear]))[:, 0].mean()))
        window, cells = search.window(front, rear)
        bounds = Bounds(lower, upper, 0.012, 0.006, 0.0)
        start = np.concatenate([wanted, [front, rear]])
        numbers = np.concatenate([wanted, rules.weights, dimensions(robot), window])
        theirs = pose_solver(layout, links, cells).solve(numbers, bounds, [start])
        task = _core.PoseTask(
            wanted, rules.weights, lower, upper, 0.012, 0.006, 0.0, links, (-np.inf, np.inf)
        )
        ours = search.problem.solve(task, start[[0, 1, 2, 7, 8]])
        yield search, (ours.x, ours.cost, ours.violation), theirs


@pytest.mark.parametrize("seed", range(16))
def test_whole_links(seed):
    for search, (x, _, violation), theirs in both(seed, links=True):
        assert (violation <= 1e-6) >= theirs.solved
        if violation > 1e-6:
            continue
        trunk, q = (float(x[0]), float(x[1]), float(x[2])), x[3:7]
        verdict = check(search.robot, search.path.vertices, *trunk, q)
        assert verdict.clearance >= 0.012 - 1e-6
        assert verdict.legs_apart >= 0.006 - 1e-6


@pytest.mark.parametrize("links", [True, False])
def test_same_optimum(links):
    """Nearly always: hard maxima make several optima."""
    same = []
    for seed in range(20, 30):
        for _, (x, cost, violation), theirs in both(seed, links, count=4):
            if violation <= 1e-6 and theirs.solved:
                same.append(abs(cost - theirs.cost) < 1e-6 + 1e-5 * cost)
                if same[-1]:
                    assert np.allclose(x, theirs.x, atol=2e-3)
    assert len(same) > 25
    assert np.mean(same) > 0.9


@pytest.mark.parametrize("name", ["ramp-1-8", "single-stair-030", "curb-015"])
def test_same_poses(name):
    """Pulls for balance included, at every place of the rear wheel that both can solve."""
    robot, weights = sw.load_robot("a1_wheeled"), CriticalWeights()
    path = wheel_path(sw.load_terrain(name), robot.wheel.radius)
    ours, theirs = (kind(robot, path, 0.6, weights) for kind in (PoseSearch, CasadiSearch))
    obstacle = find_obstacles(path, 0.3, path.length - 0.3)[0]
    before = np.array([0.0, 0.33, 0.0, *ours.standing, 0.5, 0.25])
    place = ContactPair(obstacle.begin, (0.3, path.length), True, obstacle.steepest, True, before)
    rears = ours.rear_places(place, True)
    same = 0
    for rear in rears:
        a, b = ours.solve(place, float(rear)), theirs.solve(place, float(rear))
        if a.solution.solved and b.solution.solved:
            same += abs(a.margin - b.margin) < 1e-3 and abs(a.turn - b.turn) < 1e-2
    assert same > 0.8 * len(rears)
