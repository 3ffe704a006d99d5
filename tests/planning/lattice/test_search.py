"""One search: what its passes may leave out changes nothing of what they find."""

import numpy as np
import pytest

from stairwright import _core
from stairwright.library import load_robot
from stairwright.planning.lattice import search
from stairwright.planning.lattice.body_lattice import LOOSE, LOOSEST, make_lattice
from stairwright.planning.lattice.search import Search
from stairwright.planning.path_planner import PathPlanner, path_planner
from stairwright.planning.weights import PathWeights
from stairwright.terrain.profile import Terrain


def steps(seed: int, rise: float, friction: float = 0.6) -> PathPlanner:
    """Four steps up or down of up to `rise`, close together."""
    random = np.random.default_rng(seed)
    points = [(-1.2, 0.0), (0.0, 0.0)]
    for _ in range(4):
        x, z = points[-1]
        z += random.uniform(-rise, rise)
        points += [(x, z), (x + random.uniform(0.15, 0.5), z)]
    points.append((points[-1][0] + 1.2, points[-1][1]))
    terrain = Terrain(name="steps", points=points)
    return path_planner(terrain, load_robot("a1_wheeled"), friction, PathWeights())


def search_of(planner: PathPlanner, bounds) -> Search:
    return Search(planner, *planner.ends, make_lattice(planner.robot, 2.0), bounds)


def spied(monkeypatch, kind, everywhere: bool):
    """The searches of a kind that sweep from now on, one entry a sweep."""
    sweep, swept = kind.sweep, []

    def spy(paths, *rest):
        if everywhere:
            paths.look_everywhere()
        swept.append(paths)
        return sweep(paths, *rest)

    monkeypatch.setattr(kind, "sweep", spy)
    return swept


def swept(planner: PathPlanner, monkeypatch, everywhere: bool):
    """What sweeps that roll back reach, how many there are, and how many cells they look at."""
    sweeps = spied(monkeypatch, _core.WidestPaths, everywhere)
    search_of(planner, LOOSEST).find(planner.friction, planner.reserve, LOOSEST.com, False, True)
    monkeypatch.undo()
    widest = sweeps[-1]
    widths = {int(c): widest.width(int(c)).copy() for c in np.flatnonzero(widest.best)}
    return widths, len(sweeps), widest.visits


@pytest.mark.parametrize("seed", range(4))
def test_sweeps_reach_what_they_would_if_they_looked_everywhere(seed, monkeypatch):
    planner = steps(seed, 0.7, 0.4)
    widths, sweeps, looked = swept(planner, monkeypatch, False)
    all_widths, all_sweeps, all_looked = swept(planner, monkeypatch, True)
    assert sweeps == all_sweeps > 2
    assert looked < all_looked
    assert widths.keys() == all_widths.keys()
    assert all(np.array_equal(width, all_widths[c]) for c, width in widths.items())


def rolls_back(monkeypatch):
    """Make a search believe that there is no way forward only."""
    arrival, asked = search.arrival, []

    def none_at_first(lat, v, goals, target):
        best, goal, pose = arrival(lat, v, goals, target)
        asked.append(best)
        return (0 if len(asked) == 1 else best), goal, pose

    monkeypatch.setattr(search, "arrival", none_at_first)


def way_of(planner: PathPlanner, monkeypatch, back: bool):
    if back:
        rolls_back(monkeypatch)
    found = search_of(planner, LOOSE).find(planner.friction, planner.reserve, LOOSE.com, True, back)
    monkeypatch.undo()
    assert found.s is not None
    assert found.back == back
    return found


@pytest.mark.parametrize("back", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_the_cheapest_way_goes_through_cells_that_lead_to_the_goal(seed, back, monkeypatch):
    planner = steps(seed, 0.12)
    found, spared = way_of(planner, monkeypatch, back), []
    leading_to = _core.WidestPaths.leading_to

    def all_wide(widest, level, goal, moves):
        wide = widest.best >= level
        spared.append(wide & ~leading_to(widest, level, goal, moves))
        return wide

    monkeypatch.setattr(_core.WidestPaths, "leading_to", all_wide)
    same = way_of(planner, monkeypatch, back)
    assert np.array_equal(found.s, same.s)
    assert np.array_equal(found.body, same.body)
    assert spared[0].any() or back  # back, nearly every cell leads to the goal


@pytest.mark.parametrize("seed", range(3))
def test_the_cheapest_way_back_is_that_of_sweeps_that_look_everywhere(seed, monkeypatch):
    planner = steps(seed, 0.12)
    ways, last = [], []
    for everywhere in (False, True):
        sweeps = spied(monkeypatch, _core.CheapestPaths, everywhere)
        ways.append(way_of(planner, monkeypatch, True))
        last.append(sweeps[-1].visits)
    assert last[0] < last[1]
    assert np.array_equal(ways[0].s, ways[1].s)
    assert np.array_equal(ways[0].body, ways[1].body)


def test_whether_there_is_a_way_does_not_depend_on_the_reserve():
    open_ones = 0
    for seed in range(12):
        planner = steps(seed, 0.3)
        one = search_of(planner, LOOSE)
        asked = one.find(planner.friction, planner.reserve, LOOSE.com, cheap=False)
        found = one.find(planner.friction, planner.reserve, LOOSE.com)
        assert (asked.quality > 0) == (found.s is not None)
        open_ones += asked.quality > 0
    assert 0 < open_ones < 12
