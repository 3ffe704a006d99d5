"""Questions about pieces of a course: what leads all the way leads through each of them."""

import numpy as np
import pytest

from stairwright.library import load_robot
from stairwright.planning.certificate.certify import certify
from stairwright.planning.lattice.body_lattice import LOOSE
from stairwright.planning.lattice.pieces import Piece, passes, pieces, stops
from stairwright.planning.path_planner import PathPlanner, path_planner
from stairwright.planning.planner import plan
from stairwright.planning.weights import PathWeights
from stairwright.terrain.profile import Terrain

FINE = 1.7
WALLS = (2.0, 4.0)  # x of the walls


def planner(points, friction=0.6, robot="a1_wheeled") -> PathPlanner:
    terrain = Terrain(name="course", points=points)
    return path_planner(terrain, load_robot(robot), friction, PathWeights())


def walls(*heights: float) -> list[tuple[float, float]]:
    """Walls up and down again on level ground of 8 m, 2 m apart."""
    points = [(-1.2, 0.0)]
    for k, height in enumerate(heights):
        x = 2.0 * (k + 1)
        points += [(x, 0.0), (x, height), (x + 0.6, height), (x + 0.6, 0.0)]
    return [*points, (6.8, 0.0)]


def at(planner: PathPlanner, x: float) -> tuple[float, float]:
    """Arc lengths of wheels half a metre apart, the front one at `x`."""
    front = planner.path.at_x(x)
    return front, max(front - 0.5, planner.ends[0].wheels[1])


@pytest.mark.parametrize("seed", range(6))
def test_a_way_from_start_to_goal_leads_through_every_piece(seed):
    random = np.random.default_rng(seed)
    points = [(-1.2, 0.0), (0.0, 0.0)]
    for _ in range(10):
        x, z = points[-1]
        z += random.uniform(-0.15, 0.15)
        points += [(x, z), (x + random.uniform(0.3, 0.6), z)]
    question = planner([*points, (points[-1][0] + 1.2, points[-1][1])])
    assert question.find(FINE, LOOSE, cheap=False).quality > 0
    for x in np.linspace(0.3, points[-1][0], 8):
        for piece in pieces(question, [at(question, float(x))]):
            assert not piece.whole
            assert passes(question, piece, LOOSE, FINE)


def test_only_the_pieces_round_obstructions_are_closed():
    question = planner(walls(1.2, 0.1))
    [first], [second] = (pieces(question, [at(question, x)]) for x in WALLS)
    assert not passes(question, first, LOOSE, FINE)
    assert passes(question, second, LOOSE, FINE)


def test_every_obstruction_ahead_is_found():
    points = [*walls(0.9, 0.0)[:-5], (3.2, 0.0), (3.2, 0.9), (5.0, 0.9)]
    question = planner(points)
    found = stops(question, at(question, 1.5), LOOSE, FINE)
    x = question.path.contacts(np.array([front for front, _ in found]))[:, 0]
    assert np.abs(x[:, None] - [2.0, 3.2]).min(axis=0) == pytest.approx(0.0, abs=0.3)
    easy = planner(walls(0.1, 0.1))
    assert stops(easy, at(easy, 1.5), LOOSE, FINE) == ()


def test_pieces_that_overlap_are_one_and_most_of_a_course_is_all_of_it():
    question = planner(walls(0.1, 0.1))
    near = pieces(question, [at(question, x) for x in (2.0, 2.5)])
    assert len(near) == 1
    apart = pieces(question, [at(question, x) for x in (0.5, 5.0)])
    assert len(apart) == 2
    assert apart[0].high < apart[1].low
    assert pieces(question, [at(question, x) for x in np.arange(0.5, 6.0, 0.5)])[0].whole
    begin, end = question.ends
    assert pieces(question, []) == [Piece(begin.wheels[1], end.wheels[0], False, False)]


@pytest.mark.slow
def test_two_obstructions_are_answered_with_what_opens_both():
    terrain = Terrain(name="walls", points=walls(0.97, 1.0))
    infeasible = plan(terrain, "a1_wheeled_x", 0.6)
    problem = infeasible.problem
    assert not infeasible.feasible
    assert problem.at[0] == pytest.approx(WALLS[0], abs=0.3)
    assert infeasible.poses[-1].contacts[0][0] == pytest.approx(problem.at[0], abs=0.3)
    assert problem.limit.quantity == "leg length"
    described = load_robot("a1_wheeled_x").model_dump()
    for part in ("thigh", "calf"):
        described[part]["length"] *= problem.limit.needed / problem.limit.available
    longer = plan(terrain, described, 0.6)
    assert longer.feasible
    assert certify(longer).passed


@pytest.mark.slow
def test_a_way_to_an_obstruction_does_not_change_its_verdict():
    """The same wall on a short course, and as the second obstacle of a long one."""
    short = [(-1.2, 0.0), (0.0, 0.0), (0.0, 1.0), (0.6, 1.0), (0.6, 0.0), (2.4, 0.0)]
    one, two = (
        plan(Terrain(name="walls", points=points), "a1_wheeled_x", 0.6).problem.limit
        for points in (short, walls(0.1, 1.0))
    )
    assert one.quantity == two.quantity == "leg length"
    assert two.needed == pytest.approx(one.needed, rel=0.1)
