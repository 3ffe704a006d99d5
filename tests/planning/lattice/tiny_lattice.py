"""A lattice small enough to try every path: random tables, five samples, a 3 x 3 x 4 window."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from stairwright import _core
from stairwright.library import load_robot

NT, NZ, NX, ROW, STEP, TURN = 3, 3, 4, 16, 0.05, 0.1
SAMPLES = 5
MOVES = [(1, 1), (1, 0), (0, 1), (1, -1), (-1, 1), (-1, 0), (0, -1), (-1, -1)]
INF = np.float32(1e9)


def bits(row: Any) -> int:
    """A bitset of the entries below INF."""
    return sum(1 << k for k, value in enumerate(row) if value < INF)


@dataclass
class Tiny:
    """Problem, cells, and what brute force reads of them."""

    problem: _core.LatticeProblem
    cells: _core.LatticeCells
    front: Any
    rear: Any
    origin: Any
    possible: Any  # (cells, NT, NZ, NX) poses
    cost: Any  # likewise, of legs and trunk
    com: Any  # (cells, 6)
    s: Any
    x: Any  # (NX,) x of the CoM

    def widest(self) -> _core.WidestPaths:
        return _core.WidestPaths(self.problem, self.cells, self.com)


def make_tiny(seed: int) -> Tiny:
    """Legs weigh nothing about their wheels, so the CoM is the trunk's share of its place."""
    random = np.random.default_rng(seed)
    robot = load_robot("a1_wheeled")
    s = 0.05 * np.arange(SAMPLES)
    centres = np.stack([s, np.zeros(SAMPLES)], axis=1)

    def costs(shape: tuple[int, ...], share: float) -> Any:
        out = random.uniform(0.0, 2.0, shape).astype(np.float32)
        out[random.uniform(size=shape) < share] = INF
        return out

    def leg() -> tuple[Any, _core.LatticeLegTable]:
        cost = np.full((SAMPLES, NT, NZ, ROW), INF, np.float32)
        cost[..., :NX] = costs((SAMPLES, NT, NZ, NX), 0.25)
        possible = np.apply_along_axis(bits, 3, cost).astype(np.uint64)
        none = np.zeros((SAMPLES, NT), np.int32)
        moment = np.zeros((2, 2, NZ, NZ + ROW), np.float32)[..., :NZ].copy()
        carried = np.zeros(SAMPLES, np.float32)
        made = _core.lattice_leg_table(cost, possible, moment, carried, none, none, none, none)
        return cost[..., :NX], made

    (front_cost, front), (rear_cost, rear) = leg(), leg()
    trunk_cost = np.full((NT, NZ, 2 * NX), INF, np.float32)
    trunk_cost[..., :NX] = costs((NT, NZ, NX), 0.1)
    trunk_bits = np.zeros((NT, NZ, NX), np.uint64)
    for t, z, x in np.ndindex(NT, NZ, NX):
        trunk_bits[t, z, x] = bits(trunk_cost[t, z, x:NX])
    trunk = _core.lattice_trunk_table(trunk_cost, trunk_bits, 0, 0)
    shape = _core.Lattice(STEP, TURN, NT, NT, NZ, NX, ROW)
    problem = _core.lattice_problem(
        _core.RobotModel(robot.native), shape, s, centres, front, rear, trunk, -10.0, 0.0
    )
    pairs = [(f, r) for f in range(SAMPLES) for r in range(SAMPLES) if random.uniform() < 0.9]
    number = {pair: c for c, pair in enumerate(pairs)}
    fronts, rears = (np.array(column, np.int32) for column in zip(*pairs, strict=True))
    origin = np.array(
        [[number.get((f - a, r - b), -1) for a, b in MOVES] for f, r in pairs], np.int32
    )
    n = len(pairs)
    none, slope = np.zeros(n, np.int32), np.zeros(n)
    cells = problem.cells(fronts, rears, none, none, none, slope, origin)
    x = robot.body.mass / robot.mass * STEP * np.arange(NX)
    low = random.uniform(-0.06, 0.01, n)
    com = np.stack([low, low + 0.15, low + 0.02, low + 0.12, low + 0.01, low + 0.13], axis=1)
    total = front_cost[fronts] + rear_cost[rears] + trunk_cost[None, ..., :NX]
    return Tiny(problem, cells, fronts, rears, origin, total < INF, total, com, s, x)


def quality(tiny: Tiny, c: int) -> Any:
    """(NX,) quality of the poses of a cell by their column."""
    low, high, firm_low, firm_high = tiny.com[c, :4]
    margin = np.minimum(tiny.x - low, high - tiny.x)
    firm = np.minimum(tiny.x - firm_low, firm_high - tiny.x)
    base = 99.0 * np.minimum(1.0, margin / 0.06) + 1.0
    more = 154.0 * np.minimum(1.0, firm / 0.06) + 101.0
    return np.where(margin < 0.0, 0, np.where(firm >= 0.0, more, base).astype(np.int64))


@cache
def neighbours(t: int, z: int, x: int) -> list[tuple[tuple[int, int, int], float]]:
    """Poses within two lattice steps along each axis, with how many steps they are away."""
    return [
        ((a, b, c), sum(2.6 if abs(d) == 2 else abs(d) for d in (a - t, b - z, c - x)))
        for a in range(max(0, t - 2), min(NT, t + 3))
        for b in range(max(0, z - 2), min(NZ, z + 3))
        for c in range(max(0, x - 2), min(NX, x + 3))
    ]


def pose_cost(tiny: Tiny, c: int, weights: dict[str, float]) -> Any:
    """(NT, NZ, NX) cost of the poses of a cell."""
    pitch = (np.arange(NT) - NT // 2) * TURN
    rise = STEP * np.arange(NZ) / weights["height"] - 1.0
    wanted = weights["wanted_margin"]

    def missing(low: float, high: float) -> Any:
        margin = np.minimum(tiny.x - low, high - tiny.x)
        return np.maximum(0.0, wanted - np.maximum(-0.06, margin)) / wanted

    lost = missing(*tiny.com[c, 4:6]) ** 2 + missing(*tiny.com[c, 2:4]) ** 2
    out = 0.5 * tiny.cost[c].astype(float) + 0.25 * weights["com_margin"] * lost
    out += 0.075 * weights["pitch"] * pitch[:, None, None] ** 2 + 0.3 * rise[:, None] ** 2
    return out


def move_cost(tiny: Tiny, c: int, move: int) -> float:
    """Cost of rolling into a cell."""
    rolled = abs(MOVES[move][0]) + abs(MOVES[move][1])
    factor = 1.0 if move == 0 else 1.25 if move < 3 else 2.5
    return rolled * STEP * factor / (2.0 * STEP)


assert math.prod((NT, NZ, NX)) < 64
