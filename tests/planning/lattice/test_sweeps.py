"""The sweeps on tiny lattices against brute force: every pose relaxed until nothing changes."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from stairwright import _core
from tests.planning.lattice.tiny_lattice import (
    NT,
    NX,
    NZ,
    ROW,
    Tiny,
    make_tiny,
    move_cost,
    neighbours,
    pose_cost,
    quality,
)

ALL, FORWARD = 8, _core.FORWARD_MOVES
BEGIN = np.array([[0, NT], [0, NZ], [0, NX]], np.int32)
WEIGHTS = {
    "com_margin": 2.0, "pitch": 3.0, "height": 0.2, "wanted_margin": 0.05, "body_step": 0.3,
}  # fmt: skip


def source_of(tiny: Tiny) -> int:
    return int(np.argmin(tiny.front + tiny.rear))


def swept(tiny: Tiny, moves: int) -> _core.WidestPaths:
    widest = tiny.widest()
    entry = np.zeros(len(tiny.front), np.bool_)
    entry[source_of(tiny)] = True
    while widest.sweep(entry, BEGIN, moves):
        pass
    return widest


def inside(volume: np.ndarray) -> np.ndarray:
    return volume.reshape(NT + 4, NZ + 4, ROW)[2:-2, 2:-2, 2 : 2 + NX]


def widths_by_force(tiny: Tiny, moves: int) -> np.ndarray:
    source, n = source_of(tiny), len(tiny.front)
    best = np.where(tiny.possible, np.array([quality(tiny, c) for c in range(n)])[:, None, None], 0)
    out = np.zeros_like(best)
    out[source] = best[source]
    changed = True
    while changed:
        changed = False
        for c, t, z, x in np.ndindex(*out.shape):
            for p in tiny.origin[c, :moves]:
                if p < 0 or best[c, t, z, x] <= out[c, t, z, x]:
                    continue
                way = max(out[(p, *q)] for q, _ in neighbours(t, z, x))
                least = min(best[c, t, z, x], way)
                if least > out[c, t, z, x]:
                    out[c, t, z, x] = least
                    changed = True
    return out


def costs_by_force(tiny: Tiny, widths: np.ndarray, level: int, moves: int) -> np.ndarray:
    out = np.full(widths.shape, np.inf)
    poses = np.array([pose_cost(tiny, c, WEIGHTS) for c in range(len(tiny.front))])
    source, wide = source_of(tiny), widths >= level
    for q, _ in neighbours(1, 1, 1):
        if wide[(source, *q)]:
            far = sum(abs(a - 1) for a in q)
            out[(source, *q)] = far + poses[(source, *q)]
    changed = True
    while changed:
        changed = False
        for c, t, z, x in np.ndindex(*out.shape):
            if not wide[c, t, z, x]:
                continue
            for m, p in enumerate(tiny.origin[c, :moves]):
                if p < 0:
                    continue
                way = min(out[(p, *q)] + WEIGHTS["body_step"] * d for q, d in neighbours(t, z, x))
                total = way + move_cost(tiny, c, m) + poses[c, t, z, x]
                if total < out[c, t, z, x] - 1e-9:
                    out[c, t, z, x] = total
                    changed = True
    return out


@pytest.mark.parametrize("moves", [FORWARD, ALL])
@pytest.mark.parametrize("seed", range(6))
def test_the_widest_paths_are_those_of_brute_force(seed, moves):
    tiny = make_tiny(seed)
    widest, expected = swept(tiny, moves), widths_by_force(tiny, moves)
    assert np.array_equal(widest.best > 0, expected.any(axis=(1, 2, 3)))
    reached = np.flatnonzero(widest.best)
    assert len(reached) > 5
    for c in reached:
        # Single precision may round the quality of a pose to the one next to it.
        assert np.abs(inside(widest.width(int(c))).astype(int) - expected[c]).max() <= 1


@pytest.mark.parametrize("moves", [FORWARD, ALL])
@pytest.mark.parametrize("seed", range(6))
def test_the_cheapest_path_is_that_of_brute_force(seed, moves):
    tiny = make_tiny(seed)
    widest, source = swept(tiny, moves), source_of(tiny)
    widths = np.zeros((len(tiny.front), NT, NZ, NX), int)
    for c in np.flatnonzero(widest.best):
        widths[c] = inside(widest.width(int(c)))
    goal, level = int(np.argmax((tiny.front + tiny.rear) * (widest.best > 0))), 1
    expected = costs_by_force(tiny, widths, level, moves)
    wanted = widest.leading_to(level, goal, moves)
    assert wanted[goal]
    assert wanted[source]
    weights = _core.LatticeWeights(**WEIGHTS)
    cheapest = _core.CheapestPaths(widest, tiny.com, wanted, level, weights, moves)
    while cheapest.sweep(source, (1, 1, 1)):
        pass
    last = cheapest.cheapest_pose(goal, BEGIN)
    assert np.isfinite(expected[goal]).any()
    assert expected[(goal, *last)] == pytest.approx(expected[goal].min(), abs=1e-3)
    rows = cheapest.backtrack(source, goal, last, 500)
    assert path_cost(tiny, rows) == pytest.approx(expected[goal].min(), abs=1e-2)


def path_cost(tiny: Tiny, rows: np.ndarray) -> float:
    """Cost of a path of rows (front, rear, pitch, z, x) by its poses and moves."""
    number = {(f, r): c for c, (f, r) in enumerate(zip(tiny.front, tiny.rear, strict=True))}
    path = [(number[f, r], (t + NT // 2, z, x)) for f, r, t, z, x in rows.tolist()]
    total = sum(pose_cost(tiny, c, WEIGHTS)[pose] for c, pose in path)
    total += sum(abs(a - 1) for a in path[0][1])
    for (before, a), (c, b) in itertools.pairwise(path):
        steps = dict(neighbours(*b))
        moves = [m for m, p in enumerate(tiny.origin[c]) if p == before]
        total += WEIGHTS["body_step"] * steps[a] + move_cost(tiny, c, moves[0])
    return float(total)


def test_what_does_not_fit_together_is_refused():
    tiny = make_tiny(0)
    n = len(tiny.front)
    with pytest.raises(ValueError, match="marks"):
        tiny.widest().sweep(np.zeros(n + 1, np.bool_), BEGIN, FORWARD)
    with pytest.raises(ValueError, match="window"):
        tiny.widest().sweep(np.zeros(n, np.bool_), BEGIN + 9, FORWARD)
    with pytest.raises(ValueError, match="moves"):
        tiny.widest().sweep(np.zeros(n, np.bool_), BEGIN, 9)
    with pytest.raises(ValueError, match="entered"):
        tiny.widest().width(0)
    with pytest.raises(ValueError, match="com"):
        _core.WidestPaths(tiny.problem, tiny.cells, tiny.com[1:])
    none, slope = np.zeros(n, np.int32), np.zeros(n)
    with pytest.raises(ValueError, match="samples"):
        tiny.problem.cells(tiny.front + 90, tiny.rear, none, none, none, slope, tiny.origin)
