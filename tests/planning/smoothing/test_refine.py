"""Smoothing keeps bounds first, and then room for ground that is not as drawn."""

import numpy as np
import pytest

from stairwright._core import pair_interval
from stairwright.library import load_robot
from stairwright.planning.path_planner import path_planner
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


def test_a_wheel_on_an_edge_may_be_beside_its_place():
    """By 3 mm, as far as no corner is between: the CoM margin of the worst such place."""
    planner = path_planner(stair(0.36), load_robot("a1_wheeled"), 0.5, PathWeights())
    found = planner.search_of(FORGIVING)
    assert found.s is not None
    assert found.body is not None
    nodes = refine(planner, planner.ends, found.s, found.body)
    path, beside = planner.path, 0.003

    def margin(front: float, rear: float, com_x: float) -> float:
        low, high = pair_interval(path.native, front, rear, 0.5)
        return min(com_x - low, high - com_x)

    tilted = 0
    for (front, rear), com, told, firm in zip(
        nodes.s, nodes.margins.com, nodes.margins.strayed_com_margin,
        nodes.margins.firm_com_margin, strict=True,
    ):  # fmt: skip
        margins = [margin(front, rear, com[0])]
        for by in (-beside, beside):
            for old, place in ((front, (front + by, rear)), (rear, (front, rear + by))):
                other = old + by
                between = (path.corners > min(old, other) - 1e-4) & (
                    path.corners <= max(old, other) + 1e-4
                )
                normals = path.normals(np.array([old, other]))
                if not between.any() and normals[0] @ normals[1] < 1.0 - 1e-6:
                    margins.append(margin(*place, com[0]))
        assert told == pytest.approx(min(margins), abs=1e-9)
        tilted += told < firm - 1e-3
    assert tilted >= 3
