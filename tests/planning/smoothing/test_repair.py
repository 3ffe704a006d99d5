"""Local repair of paths: what it mends that the polish alone does not, and what it leaves alone."""

import itertools

import numpy as np
import pytest

from stairwright.library import load_robot
from stairwright.planning.attempt import Attempt, Solved
from stairwright.planning.certificate.certify import judge
from stairwright.planning.lattice.body_lattice import LOOSE
from stairwright.planning.path_planner import PathPlanner, path_planner
from stairwright.planning.planner import plan
from stairwright.planning.smoothing import repair as repairs
from stairwright.planning.smoothing.refine import Refined, refine
from stairwright.planning.smoothing.repair import STAGES, repair
from stairwright.planning.strategy import MOST_FORGIVING, ON_BRINKS
from stairwright.planning.weights import PathWeights
from stairwright.terrain.stairs import stair

NONE = np.empty(0, np.int64)


def smoothed(planner: PathPlanner) -> Refined:
    """What the polish alone makes of the widest way."""
    way = planner.find(1.7, LOOSE)
    assert way.s is not None
    assert way.body is not None
    return refine(planner, planner.ends, way.s, way.body)


def flight(direction, robot: str, friction: float, rise=0.18, run=0.28) -> PathPlanner:
    terrain = stair(rise, run, 3, direction=direction)
    return path_planner(terrain, load_robot(robot), friction, PathWeights())


@pytest.mark.parametrize(("rise", "run", "friction"), [(0.16, 0.29, 0.6), (0.17, 0.27, 0.6)])
def test_a_path_that_the_polish_leaves_bad_is_mended(rise, run, friction):
    planner = flight("down", "a1_wheeled", friction, rise, run)
    assert smoothed(planner).margins.worst < -0.005
    answer = planner.attempt(Attempt(1.7, LOOSE))
    assert isinstance(answer, Solved)
    assert answer.certificate.passed


def test_down_a_stair_rear_wheels_wait_at_the_edge():
    """Farther back the front legs do not reach the next tread, farther on the edge is slippery."""
    planner = flight("down", "d1", 0.6, 0.195, 0.255)
    assert not isinstance(planner.attempt(MOST_FORGIVING), Solved)
    assert isinstance(planner.attempt(ON_BRINKS), Solved)


def test_between_nodes_wheels_keep_to_both_faces_of_a_corner():
    """Trunks of large robots move far while a wheel rests in one, and joints move linearly."""
    planner = path_planner(stair(0.17, 0.29, 30), load_robot("b2w"), 0.6, PathWeights())
    certificate = judge(planner.motion(smoothed(planner)))
    sunk = next(c for c in certificate.checks if c.name == "wheels sunk into the ground")
    assert sunk.passed, sunk


def test_only_pieces_round_bad_places_change():
    """Their ends stay, wheels never roll back, and the record is that of the whole path."""
    planner = flight("down", "a1_wheeled", 0.6)
    found = smoothed(planner)
    bad = found.margins.bad
    mended = repair(planner, found, bad, STAGES[1])
    assert len(mended.margins.bad) < len(bad)
    same = (mended.s[:, None] == found.s).all(axis=2) & (mended.body[:, None] == found.body).all(
        axis=2
    )
    kept = same.any(axis=0)
    travel = found.s.mean(axis=1)
    near = np.abs(travel[:, None] - travel[bad]).min(axis=1)
    assert kept[near > 0.3].all()
    assert not kept[bad].any()
    assert kept[[0, -1]].all()
    assert (np.diff(mended.s, axis=0) >= 0.0).all()
    whole = planner.refine_problem.margins(np.hstack([mended.s, mended.body]))
    assert np.array_equal(whole["q"], mended.margins.q)
    assert np.array_equal(whole["com_margin"], mended.margins.com_margin)


def test_pieces_of_neighbours_do_not_overlap(monkeypatch):
    """Bad places a little farther apart than two pieces reach, and nearer."""
    planner = flight("up", "a1_wheeled", 0.6)
    found = smoothed(planner)
    ways = []
    monkeypatch.setattr(
        repairs, "_local_path", lambda q, found, begin, end, *_: ways.append((begin, end)) or (0, 0)
    )
    monkeypatch.setattr(repairs, "_smoothed", lambda q, old, way, bad: old)
    travel = found.s.mean(axis=1) - found.s[0].mean()
    for apart in np.arange(0.3, 0.4, 0.002):
        ways.clear()
        bad = np.searchsorted(travel, [0.5, 0.5 + apart])
        mended = repair(planner, found, bad, STAGES[0])
        assert np.array_equal(mended.s, found.s)
        assert len(ways) == (1 if np.diff(travel[bad])[0] <= 0.36 else 2)
        assert all(a[1] < b[0] for a, b in itertools.pairwise(ways))


def test_more_places_than_a_stage_is_for_are_left_alone():
    planner = flight("up", "a1_wheeled", 0.6)
    found = smoothed(planner)
    both = np.array([30, len(found.s) - 30])
    alone = repair(planner, found, both, STAGES[1]._replace(places=1))
    assert np.array_equal(alone.body, found.body)
    assert np.array_equal(repair(planner, found, NONE, STAGES[1]).body, found.body)


def test_a_place_longer_than_a_stage_is_for_is_left_alone():
    planner = flight("up", "a1_wheeled", 0.6)
    found = smoothed(planner)
    travel = found.s.mean(axis=1) - found.s[0].mean()
    stage = STAGES[1]._replace(longest=0.3)
    assert repair(planner, found, np.flatnonzero((travel > 0.4) & (travel < 0.8)), stage) is found
    short = np.flatnonzero((travel > 0.4) & (travel < 0.5))
    assert repair(planner, found, short, stage) is not found


def test_a_long_bad_place_is_mended():
    """Knees back, down a flight, with little friction: 0.67 m are bad."""
    terrain = stair(0.12, 0.22, 5, direction="down")
    answer = plan(terrain, "a1_wheeled", 0.35)
    assert answer.feasible
