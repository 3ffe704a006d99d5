"""Smoothing keeps bounds first, and then room for ground that is not as drawn."""

import numpy as np
import pytest

from stairwright.library import load_robot
from stairwright.planning.path_planner import path_planner
from stairwright.planning.planner import plan
from stairwright.planning.smoothing.refine import refine, refine_with_room
from stairwright.planning.strategy import FORGIVING
from stairwright.planning.weights import PathWeights
from stairwright.terrain.stairs import stair


@pytest.mark.parametrize(
    ("robot", "rise", "friction"), [("a1_wheeled_x", 0.6, 0.3), ("go2w", 0.55, 0.8)]
)
def test_room_for_other_ground_violates_no_bound(robot, rise, friction):
    planner = path_planner(stair(rise, 0.38, 3), load_robot(robot), friction, PathWeights())
    found = planner.search_of(FORGIVING)
    assert found.s is not None
    assert found.body is not None
    path = planner.ends, found.s, found.body
    assert refine(planner, *path).margins.worst < 0.0
    kept = refine_with_room(planner, *path)
    assert kept.margins.worst > 0.0

    def cost(nodes):
        return planner.refine_problem.cost(np.hstack([nodes.s, nodes.body]))[0]

    nowhere = refine(planner, *path, as_drawn=kept.s)
    assert nowhere.margins.worst > 0.0
    assert cost(kept) < cost(nowhere), "where there is room, it is kept"


def test_room_for_other_ground_refuses_no_wall():
    """Half of that height was what an A1-X was planned up, for a knee's room to a riser 6 cm early."""
    assert plan(stair(0.66), "a1_wheeled_x", 0.2).feasible
