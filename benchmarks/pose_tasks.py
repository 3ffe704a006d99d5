"""The pose problem that all solvers of `poses.py` get, and the exact check of their answers."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import casadi as ca
import numpy as np
from numpy.typing import NDArray

import stairwright as sw
from stairwright import _core
from stairwright.planning.poses.casadi_search import CasadiSearch
from stairwright.planning.poses.nlp import HIP, SELF, WHEEL, Layout, build
from stairwright.planning.poses.pose_search import CLEARANCE, LEGS_DISTANCE, PoseSearch
from stairwright.planning.weights import CriticalWeights
from stairwright.robot.description import Robot
from stairwright.robot.symbolic import dimensions
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import wheel_path

sys.path.insert(0, str(Path(__file__).parent.parent))

from tests.shapely_checker import check  # found by the path above

Floats = NDArray[np.float64]

FRICTION = 0.6
_RAISED, _HIGHER = 0.6, 0.1  # rad, m; of further first guesses
_SLACK = 1e-5  # m and rad; what the exact check forgives


@dataclass(frozen=True)
class Task:
    """Two poses of one terrain: places of the front wheels, and about where the rear ones are."""

    terrain: Terrain
    robot: Robot
    places: tuple[tuple[float, float], tuple[float, float]]
    climbs: bool
    warm: tuple[Floats, Floats] | None = None  # solutions of a neighbouring terrain


def make_task(terrain: Terrain, robot: Robot) -> Task | None:
    """The two poses of the first obstacle, where a plan puts them; None without an obstacle."""
    plan = sw.plan(terrain, robot, FRICTION, method="critical")
    if len(plan.critical) < 2:
        return None
    first, second = (plan.poses[k] for k in plan.critical[:2])
    climbs = bool(second.wheels[0][1] > first.wheels[0][1])
    return Task(terrain, robot, (first.wheel_progress, second.wheel_progress), climbs)


class Numbers:
    """What every solver needs of one task; made anew for each timed solve."""

    def __init__(self, task: Task) -> None:
        self.task = task
        self.path = wheel_path(task.terrain, task.robot.wheel.radius)
        self.search = PoseSearch(task.robot, self.path, FRICTION, CriticalWeights())
        # Wheel centres (pose, front or rear, x or z).
        self.centres = self.path.centres(np.array(task.places).ravel()).reshape(2, 2, 2)

        # Trunk and joints (pose, 7) that eq 17 pulls to.
        self.wanted = np.empty((2, 7))
        for k, (front, rear) in enumerate(self.centres):
            middle = (front[0] + rear[0]) / 2
            self.wanted[k] = self.search.problem.reference_posture(middle)

    def bounds(self, k: int) -> tuple[Floats, Floats]:
        """Of the nine variables of pose `k`."""
        front, rear = self.task.places[k]
        lower, upper = self.search.rules.lower.copy(), self.search.rules.upper.copy()
        lower[7] = upper[7] = front
        lower[8], upper[8] = rear - _core.REAR_SPACING / 2, rear + _core.REAR_SPACING / 2
        return lower, upper

    @property
    def hip(self) -> float:
        """Least distance by which the rear contact lies behind the rear hip (eq 20)."""
        return 0.0 if self.task.climbs else -math.inf

    def guesses(self, k: int) -> list[Floats]:
        """First guesses (9,) of pose `k`, the same for every solver."""
        wanted, places = self.wanted[k], np.array(self.task.places[k])
        a, b = self.centres[k]
        if self.task.warm is not None:
            x = self.task.warm[k].copy()
            x[7:] = places
            return [x]
        line = -0.8 * math.atan2(a[1] - b[1], max(a[0] - b[0], 0.1))
        others = ((line, 0.0), (0.0, 0.0), (-_RAISED, _HIGHER), (_RAISED, _HIGHER))
        out = np.tile(np.concatenate([wanted, places]), (len(others), 1))
        out[:, 2] = [pitch for pitch, _ in others]
        out[:, 1] += [higher for _, higher in others]
        return list(out)


class Nlp:
    """The CasADi form of one pose: functions and bounds, as any solver can use them."""

    def __init__(self, numbers: Numbers, k: int) -> None:
        robot = numbers.task.robot
        plain = CasadiSearch(robot, numbers.path, FRICTION, CriticalWeights())
        window, cells = plain.window(*numbers.task.places[k])
        self.functions = _functions(_layout(robot), cells)
        self.parameters = np.concatenate(
            [numbers.wanted[k], numbers.search.rules.weights, dimensions(robot), window]
        )
        self.lower, self.upper = numbers.bounds(k)
        kinds = np.array(self.functions.rows)
        least = np.where(
            kinds == HIP, numbers.hip, np.where(kinds == SELF, LEGS_DISTANCE, CLEARANCE)
        )
        self.equal = kinds == WHEEL
        self.least = np.where(self.equal, 0.0, least)
        self.most = np.where(self.equal, 0.0, math.inf)

    def cost(self, x: Floats) -> float:
        return float(self.functions.f(x, self.parameters))

    def gradient(self, x: Floats) -> Floats:
        return np.asarray(self.functions.df(x, self.parameters), float).ravel()

    def rows(self, x: Floats) -> Floats:
        return np.asarray(self.functions.g(x, self.parameters), float).ravel()

    def jacobian(self, x: Floats) -> Floats:
        return np.asarray(self.functions.dg(x, self.parameters), float)


class _Functions:
    """Value and derivative functions of one problem, made once per process."""

    def __init__(self, layout: Layout, cells: int) -> None:
        self.problem = build(layout, links=True, cells=cells)
        self.rows = self.problem.rows
        x, p = self.problem.nlp["x"], self.problem.nlp["p"]
        f, g = self.problem.nlp["f"], self.problem.nlp["g"]
        self.f, self.g = ca.Function("f", [x, p], [f]), ca.Function("g", [x, p], [g])
        self.df = ca.Function("df", [x, p], [ca.gradient(f, x)])
        self.dg = ca.Function("dg", [x, p], [ca.densify(ca.jacobian(g, x))])
        self.solvers: dict[str, ca.Function] = {}

    @cached_property
    def sparse(self) -> dict[str, ca.SX]:
        return self.problem.nlp


_CACHE: dict[tuple[Layout, int], _Functions] = {}


def _functions(layout: Layout, cells: int) -> _Functions:
    if (layout, cells) not in _CACHE:
        _CACHE[layout, cells] = _Functions(layout, cells)
    return _CACHE[layout, cells]


def _layout(robot: Robot) -> Layout:
    points = robot.collision_points
    return Layout(tuple(points.trunk), tuple(points.thigh), tuple(points.calf))


def sound(task: Task, k: int, x: Floats) -> bool:
    """Whether pose `k` keeps every constraint, by the exact checker (shapely)."""
    if not np.all(np.isfinite(x)):
        return False
    robot = task.robot
    path = wheel_path(task.terrain, robot.wheel.radius)
    verdict = check(robot, task.terrain.vertices, *(float(v) for v in x[:3]), x[3:7])
    rear = path.contacts(x[8:9])[0]
    hip = x[0] + math.cos(x[2]) * robot.hips.rear[0] + math.sin(x[2]) * robot.hips.rear[1]
    return bool(
        verdict.wheel_gap <= _SLACK
        and verdict.clearance >= CLEARANCE - _SLACK
        and verdict.legs_apart >= LEGS_DISTANCE - _SLACK
        and verdict.joint_slack >= -_SLACK
        and (not task.climbs or rear[0] <= hip + _SLACK)
        and abs(x[7] - task.places[k][0]) <= _SLACK
        and abs(x[8] - task.places[k][1]) <= _core.REAR_SPACING / 2 + _SLACK
    )
