"""Two optimal poses, the paper's task of a single stair: Stairwright against general solvers.

    python benchmarks/poses.py [--quick] [--json FILE]

Every solver gets the same problem (eqs 17-22, whole links, exact wheel curve), the same first
guesses and the same time to prepare the terrain in; a task counts as solved where both answers
pass the exact check of the tests (shapely). Cold tasks start from standing poses, warm ones from
the answer for a terrain whose corner was a few millimetres away. The last rows are the whole plan:
search for the rear wheel's place, margins and certificate included.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Sequence
from dataclasses import replace

from pose_peers import Solver, peers, stairwright
from pose_tasks import Task, make_task, sound
from profiles import random_profile
from report import Row, command, percentile, times

import stairwright as sw
from stairwright.terrain.profile import Terrain
from stairwright.terrain.stairs import stair

ROBOTS = ("a1_wheeled", "a1_wheeled_x")
SLOW = {
    "SciPy SLSQP, finite differences": 30,
    "Drake SNOPT": 60,
    "Octave sqp, exact derivatives": 10,
}
_NUDGE = 0.004  # m that a corner is moved for a warm start


def stair_tasks(count: int, warm: bool) -> list[Task]:
    """The 0.36 m stair, its height varied by less than a millimetre: no task is seen twice."""
    robot = sw.load_robot(ROBOTS[0])
    tasks = [_task(stair(0.36 + 1e-5 * k), robot) for k in range(count)]
    if not warm:
        return tasks
    near = stairwright(_task(stair(0.36 - _NUDGE), robot))
    return [replace(task, warm=near) for task in tasks]


def _task(terrain: Terrain, name: sw.Robot) -> Task:
    task = make_task(terrain, name)
    assert task is not None
    return task


def profile_tasks(count: int) -> list[Task]:
    """Random profiles with an obstacle, robots in turn."""
    tasks: list[Task] = []
    seed = 0
    while len(tasks) < count:
        task = make_task(random_profile(seed)[1], sw.load_robot(ROBOTS[seed % 2]))
        tasks += [] if task is None else [task]
        seed += 1
    return tasks


def solve_all(solver: Solver, tasks: Sequence[Task]) -> tuple[list[float], int]:
    """Times [ms] and the number of tasks whose answers pass the exact check."""
    solver(tasks[0])  # what is compiled or built once
    measured, solved = [], 0
    for task in tasks:
        begun = time.perf_counter()
        answers = solver(task)
        measured.append(1e3 * (time.perf_counter() - begun))
        solved += all(sound(task, k, x) for k, x in enumerate(answers))
    return measured, solved


def compare(work: str, tasks: Sequence[Task], quick: bool) -> list[Row]:
    """Stairwright and every peer on the same tasks."""
    ours, solved = solve_all(stairwright, tasks)
    median = statistics.median(ours)
    rows = [_row(work, "stairwright", ours, solved, median)]
    for name, solver in peers().items():
        if isinstance(solver, str):
            rows.append(Row(work, name, note=solver))
            continue
        some = tasks[: 3 if quick else SLOW.get(name, len(tasks))]
        measured, solved = solve_all(solver, some)
        rows.append(_row(work, name, measured, solved, median))
    return rows


def _row(work: str, name: str, measured: list[float], solved: int, ours: float) -> Row:
    median = statistics.median(measured)
    return Row(
        work, name, median, percentile(measured, 0.95), ratio=median / ours,
        solved=f"{solved} of {len(measured)}",
    )  # fmt: skip


def whole_plans(work: str, terrains: Sequence[Terrain]) -> list[Row]:
    """`plan(method="critical")`: with what is certified of the poses, and with the whole document.

    What stops the motion between the poses is judged when it is first read, at the latest when the
    document is written.
    """
    robots = [sw.load_robot(name) for name in ROBOTS]

    def planned(k: int) -> sw.Plan:
        return sw.plan(terrains[k], robots[k % 2], method="critical")

    plans = [planned(k) for k in range(len(terrains))]
    passed = sum(plan.certificate.passed and plan.feasible for plan in plans if plan.certificate)
    measured = [times(lambda k=k: planned(k), 1)[0] for k in range(len(terrains))]
    written = [times(lambda k=k: planned(k).model_dump_json(), 1)[0] for k in range(len(terrains))]
    median = statistics.median(measured)
    rows = [_row(work, "stairwright", each, passed, median) for each in (measured, written)]
    notes = ("with search, margins and certificate of the poses", "and of the motion; as JSON")
    return [replace(one, note=note) for one, note in zip(rows, notes, strict=True)]


def run(quick: bool = False) -> list[Row]:
    """All rows."""
    repeat, count = (5, 10) if quick else (60, 300)
    rows = []
    for start in ("cold", "warm"):
        tasks = stair_tasks(repeat, start == "warm")
        rows += compare(f"two poses, 0.36 m stair, {start}", tasks, quick)
    rows += compare(f"two poses, {count} random profiles", profile_tasks(count), quick)
    stairs = [stair(0.36 + 1e-5 * k) for k in range(repeat)]
    flights = [stair(0.17 + 1e-5 * k, 0.28, 5) for k in range(repeat)]
    profiles = [random_profile(seed)[1] for seed in range(count)]
    rows += whole_plans("whole plan, 0.36 m stair", stairs)
    rows += whole_plans("whole plan, five stairs", flights)
    rows += whole_plans(f"whole plan, {count} random profiles", profiles)
    return rows


if __name__ == "__main__":
    command(__doc__, run)
