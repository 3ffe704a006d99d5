"""Each weight of the path planner makes its own quantity small, and none decides feasibility."""

from functools import cache

import numpy as np
import pytest

import stairwright as sw
from stairwright.planning.attempt import Solved
from stairwright.planning.path_planner import path_planner
from stairwright.planning.standing import NoStandingPose
from stairwright.planning.strategy import solve
from stairwright.planning.threads import search_threads
from stairwright.planning.weights import PathWeights
from tests.planning.drawn import random_profile

A1S = ("a1_wheeled", "a1_wheeled_x")

TERMS = ("com_margin", "clearance", "torque", "smoothness", "pitch")
STEPS = (0.01, 1.0, 100.0)
# Room: where nothing is missing to begin with, nothing can get less.
WORTH = {"com_margin": 1e-3, "clearance": 2e-3, "torque": 0.02, "smoothness": 1.1, "pitch": 0.02}
ROUGH = 1.05  # the lattice's tolerance: paths are compared on it before they are smoothed


@cache  # of all weights at their default, which each term is compared with
def quantities(seed, weights):
    """The quantity of each weight along the path over a drawn profile, or None."""
    robot = sw.load_robot(A1S[seed % 2])
    try:
        planner = path_planner(random_profile(seed), robot, 0.6, weights)
    except NoStandingPose:
        return None
    found = solve(planner, search_threads())
    return planner.cost_terms(found.nodes) if isinstance(found, Solved) else None


def raised(seeds, term):
    """Rows (n, 3) of the term's own quantity as its weight is raised."""
    rows = []
    for seed in seeds:
        found = [quantities(seed, PathWeights(**{term: weight})) for weight in STEPS]
        assert len({one is None for one in found}) == 1, f"{term} decides whether there is a path"
        if found[0] is not None:
            rows.append([one[term] for one in found])
    return np.array(rows)


def holds(term, seeds):
    rows = raised(seeds, term)
    worse = (rows[:, 1:] > ROUGH * rows[:, :-1] + 0.1 * WORTH[term]).any(axis=1)
    room = rows[:, 0] > WORTH[term]
    moved = rows[room, 2] < 0.9 * rows[room, 0]
    return worse, moved


@pytest.mark.slow
@pytest.mark.parametrize("term", TERMS)
def test_a_weight_makes_its_quantity_small(term):
    """Over a few terrains; `benchmarks/weights.py` asks over fifty."""
    worse, moved = holds(term, range(400, 405))
    assert worse.sum() <= 1
    # Of clearance some lack is nobody's choice: on an edge the calf is as near as its wheel is.
    assert moved.mean() > (0.6 if term == "clearance" else 0.85)
