"""Planners that are kept from one question to the next answer as new ones do."""

from __future__ import annotations

import pytest

import stairwright as sw
from stairwright.planning.courses import Courses, kept_in
from stairwright.planning.lattice.body_lattice import STRICT
from stairwright.planning.weights import PathWeights

FLIGHT = {"points": [[-1.3, 0], [0, 0], [0, 0.12], [0.3, 0.12], [0.3, 0.24], [1.6, 0.24]]}
WALL = {"points": [[-1.3, 0], [0, 0], [0, 0.7], [1.6, 0.7]]}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("terrain", "robot"),
    [(FLIGHT, "a1_wheeled"), (FLIGHT, "anymal_wheels"), (WALL, "a1_wheeled")],
)
def test_answers_do_not_depend_on_what_was_asked_before(terrain, robot):
    kept = Courses()
    for friction in (0.6, 0.35, 0.6, 0.9):
        with kept_in(kept):
            told = sw.plan(terrain, robot, friction, diagnose=False)
        alone = sw.plan(terrain, robot, friction, diagnose=False)
        assert told.model_dump(exclude={"solve_time"}) == alone.model_dump(exclude={"solve_time"})


def test_only_questions_of_the_same_terrain_robot_and_weights_share_tables():
    kept = Courses()
    terrain, robot = sw.load_terrain("single-stair-036"), sw.load_robot("a1_wheeled")
    usual = PathWeights()
    other = usual.model_copy(update={"clearance": 2.0 * usual.clearance})

    def searches(ground, machine, wanted):
        return kept.planner(ground, machine, 0.6, wanted, fast=False).searches

    kept.planner(terrain, robot, 0.5, usual, fast=False).find(2.0, STRICT)
    assert len(searches(terrain, robot, usual)) == 1
    assert not searches(terrain, robot, other)
    assert not searches(terrain, sw.load_robot("a1_wheeled_x"), usual)
    assert len(searches(terrain, robot, usual)) == 1
    assert not searches(sw.load_terrain("single-stair-030"), robot, usual)
    assert not searches(terrain, robot, usual)
