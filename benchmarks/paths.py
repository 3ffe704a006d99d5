"""How long a certified path takes: stairs by number, long courses, random profiles, verdicts.

    python benchmarks/paths.py [--quick] [--json FILE]

The peer is one sparse problem over the whole course in IPOPT (`dense_nlp.py`), which solves fewer
of them; a row says so. Stairwright's figures include terrain preparation and the certificate.
"""

from __future__ import annotations

import gc
import math
import statistics
import time
from dataclasses import replace

from dense_nlp import DensePath
from profiles import random_profile
from report import Row, command, percentile, row, times

import stairwright as sw
from stairwright.library import load_robot, load_terrain
from stairwright.terrain.profile import Terrain

ROBOT = "a1_wheeled"
FRICTION = 0.6
KNOTS = 80


def stairs(count: int, rise: float = 0.18, run: float = 0.28) -> Terrain:
    """A flight going up."""
    points = [(-1.0, 0.0), (0.0, 0.0)]
    for k in range(count):
        points += [(k * run, (k + 1) * rise), ((k + 1) * run, (k + 1) * rise)]
    points.append((count * run + 1.0, count * rise))
    return Terrain(name=f"stairs-{count}", points=points, friction=FRICTION)


def hills(length: float) -> Terrain:
    """A long course of curbs, ramps and flats."""
    points, x, z = [(-1.0, 0.0), (0.0, 0.0)], 0.0, 0.0
    while x < length:
        points += [(x, z + 0.12), (x + 2.0, z + 0.12), (x + 3.0, z), (x + 5.0, z)]
        x += 5.0
    return Terrain(name=f"course-{length:g}", points=points, friction=FRICTION)


def wall(height: float) -> Terrain:
    """A wall that nobody climbs."""
    points = [(-1.0, 0.0), (0.0, 0.0), (0.0, height), (1.5, height)]
    return Terrain(name=f"wall-{height:g}", points=points, friction=FRICTION)


def ours(work: str, terrain: Terrain, repeat: int) -> Row:
    """Stairwright on one terrain."""
    plan = sw.plan(terrain, ROBOT)
    measured = times(lambda: sw.plan(terrain, ROBOT), repeat)
    said = plan.status if plan.problem is None else f"infeasible: {plan.problem.kind}"
    return replace(row(work, "stairwright, certified", measured), note=said)


def dense(work: str, terrain: Terrain, against: Row) -> list[Row]:
    """The peer, from nominal poses and from our path."""
    robot = load_robot(ROBOT)
    problem = DensePath(terrain, robot, FRICTION, KNOTS)
    rows = []
    for name, known in (("nominal poses", None), ("our path", sw.plan(terrain, ROBOT))):
        answer = problem.solve(known)
        took = 1e3 * answer.seconds
        ratio = took / against.median if against.median else None
        note = f"{answer.iterations} iterations, {KNOTS} knots"
        solved = "yes" if answer.solved else "no"
        rows.append(Row(work, f"IPOPT from {name}", took, ratio=ratio, solved=solved, note=note))
    return rows


def profiles(count: int) -> Row:
    """Random profiles, both robots."""
    measured, feasible = [], 0
    for seed in range(count):
        _, terrain = random_profile(seed)
        for robot in ("a1_wheeled", "a1_wheeled_x"):
            plan = sw.plan(terrain, robot)
            measured += times(lambda t=terrain, r=robot: sw.plan(t, r), 1)
            feasible += plan.feasible
    share = f"{feasible} of {len(measured)}"
    return Row(
        f"{count} random profiles, both robots", "stairwright, certified",
        statistics.median(measured), percentile(measured, 0.95), ratio=1.0, solved=share,
    )  # fmt: skip


def steep(seed: int) -> Terrain:
    """A random profile, drawn out upwards."""
    _, terrain = random_profile(seed)
    return Terrain(name=terrain.name, points=[(x, 2.5 * z) for x, z in terrain.points])


def slope(degrees: float, height: float) -> Terrain:
    """A ramp, down where `height` is negative."""
    run = abs(height) / math.tan(math.radians(degrees))
    points = [(-1.2, 0.0), (0.0, 0.0), (run, height), (run + 1.5, height)]
    return Terrain(name=f"ramp-{degrees:g}", points=points)


def ditch(width: float, depth: float) -> Terrain:
    """A ditch with vertical sides."""
    points = [(-1.2, 0.0), (0.0, 0.0), (0.0, -depth), (width, -depth), (width, 0.0)]
    return Terrain(name=f"ditch-{width:g}", points=[*points, (width + 1.5, 0.0)])


def verdicts(work: str, terrains: list[Terrain], friction: float) -> Row:
    """What stops both robots, on those of `terrains` where something does."""
    measured, asked = [], 0
    for terrain in terrains:
        for robot in ("a1_wheeled", "a1_wheeled_x"):
            began = time.perf_counter()
            plan = sw.plan(terrain, robot, friction)
            asked += 1
            if not plan.feasible:
                measured.append(1e3 * (time.perf_counter() - began))
    return Row(
        work, "stairwright", statistics.median(measured), percentile(measured, 0.95), ratio=1.0,
        solved=f"{len(measured)} of {asked} impossible",
    )  # fmt: skip


def run(quick: bool = False) -> list[Row]:
    """All rows."""
    sw.plan("curb-015", ROBOT)  # all is imported and loaded
    gc.freeze()  # as the service's workers do
    repeat = 3 if quick else 15
    rows: list[Row] = []
    single = load_terrain("single-stair-036")
    compared = [("0.36 m stair", single), ("five stairs", load_terrain("stairs-building"))]
    if quick:
        compared = compared[:1]
    for work, terrain in [("curb 0.15 m", load_terrain("curb-015")), *compared]:
        rows.append(ours(work, terrain, repeat))
        rows += dense(work, terrain, rows[-1])
    for count in (5, 20) if quick else (5, 20, 100):
        rows.append(ours(f"{count} stairs 0.18/0.28", stairs(count), min(repeat, 3)))
    for length in (10.0,) if quick else (10.0, 90.0):
        rows.append(ours(f"course of {length:g} m", hills(length), min(repeat, 3)))
    for height in (0.9, 1.5):
        rows.append(ours(f"verdict on a wall of {height:g} m", wall(height), min(repeat, 5)))
    hard = [wall(h) for h in (0.9, 1.2, 1.5, 2.0, -1.2)]
    hard += [slope(d, h) for d in (40, 50, 60) for h in (0.8, -0.8)]
    hard += [ditch(0.3, 0.4), ditch(0.5, 1.2), ditch(0.8, 1.0)]
    rows.append(verdicts("verdict on walls, ramps and ditches", hard, FRICTION))
    mixed = [steep(seed) for seed in range(4 if quick else 60)]
    rows.append(verdicts("verdict on steep random profiles, friction 0.5", mixed, 0.5))
    rows.append(profiles(5 if quick else 150))
    return rows


if __name__ == "__main__":
    command(__doc__, run)
