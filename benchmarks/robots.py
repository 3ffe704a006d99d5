"""What each robot climbs: stairs of the building codes, walls, ramps, curbs, with a payload.

    python benchmarks/robots.py [--robots go2w,b2w] [--keep FOLDER] [--write docs/robots.md]

A case counts where the plan is certified, its rollout succeeds, and 29 of 29 randomised trials
do. Were a case to fail one time in ten or more often, 29 successes in a row would come with a
probability of at most 0.9^29 = 0.047, so they support a reliability of 90 % with 95 % confidence.
ASTM counts like that: F3580-24 (stairs, of exoskeletons) has 29 repetitions without a failure as
its example for 90 %, E2804-11(2020) (stairs and landings, of response robots) asks for repetitions
that tell in a statistically significant way how reliable a robot is. Of both only what their
publisher shows was read, and trials in a simulator are no test by either. A case with fewer
successes says how the others ended, and supports less.

Each trial draws, evenly from its range, what `sw.trials` draws by default: friction +-0.1 (of 0.6),
mass +-10 %, centre of mass +-2 cm along and up, the rise of all steps together +-1 cm, sensor
noise, 4 ms of delay; the robot knows none of it. Walls are the highest on a grid of 1 cm for which
all lower ones on a grid of 10 cm are planned too, ramps likewise in degrees up to 45: they stand
at the edge of what is possible, where trials fail sooner than elsewhere. The planner chooses which
end leads (`facing: either`): the front, but where the centre of mass has little margin so and
clearly more with the rear in front. The robots know what their
own sensors tell them (`sensing: robot`). All of it is statics and simulation: no hardware has run
it.
"Not run": the trials of that row were left out for want of time, which says nothing about it.

Where trials fail: `anymal_wheels` on flights in one or two, where it weighs 9 % more than it knows
or its mass centre lies 19 mm farther forward, for its legs' motors hold no more (80 Nm; a tenth of
its mass would be found by weighing). At their highest walls robots that find their mass centre
elsewhere stop before they start where there is no plan for that; others fall or collide. A ramp of
29 degrees takes a friction of 0.554, and some trials draw less. Ramps of 45 degrees are gone up
with a pair of wheels on level ground.

With the front in front, `a1_wheeled` (all knees back) and `d1` go down these flights with 5 to 9 mm
of CoM margin or not at all, and win 6 to 17 of 29 trials; in most others they stand, as they find
that their mass centre is not where the plan has it and that there is no plan for where it is. With
the rear in front they win all. `go2w` goes down most of them so, too, for its calves would clear
the edges by 2 to 5 mm. All rows are of 2026-11-30.

Rows are kept in a folder by the hash of the code and the question, so that a run that was ended
goes on, and several may share the work.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import stairwright as sw
from stairwright.documents import content_hash
from stairwright.jobs.engine import rollout_engine
from stairwright.terrain.stairs import ramp, stair

ROBOTS = ("a1_wheeled", "a1_wheeled_x", "go2w", "b2w", "m20", "d1", "anymal_wheels")
# Largest rise and least tread of the codes [m].
CODES = {
    "IBC 0.178/0.279": (0.178, 0.279),
    "IRC 0.196/0.254": (0.196, 0.254),
    "OSHA 0.241/0.241": (0.241, 0.241),
    "DIN 18065 0.19/0.26": (0.19, 0.26),
    "UK private 0.22/0.22": (0.22, 0.22),
    "0.18/0.28": (0.18, 0.28),
}
COLUMNS = (
    "robot", "case", "planned, rollout", "trials", "least margin, or what stops it", "leads",
    "knees",
)  # fmt: skip
STEPS = 5
PAYLOAD = 0.2  # of the robot's mass
TRIALS = 29


class Kept:
    """Answers in a folder, by everything that they depend on."""

    def __init__(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self._folder = folder

    def has(self, question: list[object]) -> bool:
        """Whether the answer is kept."""
        return self._path(question).exists()

    def _path(self, question: list[object]) -> Path:
        name = content_hash([rollout_engine(), *question]).removeprefix("sha256:")
        return self._folder / f"{name}.json"

    def answer(self, question: list[object], find: Callable[[], object]) -> object:
        """What is kept, else what `find` gives, as JSON."""
        path = self._path(question)
        if not path.exists():
            unfinished = path.with_suffix(f".{os.getpid()}")
            unfinished.write_text(json.dumps(find()))
            unfinished.rename(path)
        return json.loads(path.read_text())


@dataclass(frozen=True)
class Tried:
    """What came of one case."""

    plan: sw.Plan
    outcome: str | None
    trials: str

    @property
    def succeeds(self) -> bool:
        return self.outcome == "success"

    def row(self, robot: str, case: str) -> list[str]:
        if self.plan.problem is not None:
            lack, _, _ = self.plan.problem.message.partition(":")
            return [robot, case, "no", "-", lack, "", ""]
        binding = self.plan.binding
        assert binding is not None
        units = {"torque": "Nm", "wheel_torque": "Nm", "joint_limit": "rad", "friction": ""}
        unit = units.get(binding.quantity, "m")
        least = f"{binding.quantity.replace('_', ' ')} {binding.value:.3g} {unit}".strip()
        knees = self.plan.knees
        bend = f"{knees.front}, {knees.rear}" if knees else ""
        leads = "rear" if self.plan.facing == "backward" else "front"
        return [robot, case, f"yes, {self.outcome}", self.trials or "-", least, leads, bend]


def plan_led_by_better_end(
    terrain: sw.Terrain, robot: sw.Robot, *, diagnose: bool = True
) -> sw.Plan:
    """The planner chooses which end leads."""
    return sw.plan(terrain, robot, 0.6, facing="either", diagnose=diagnose)


def tried(terrain: sw.Terrain, robot: sw.Robot, trials: int) -> Tried:
    """Plan, rollout, and randomised trials where it succeeds."""
    plan = plan_led_by_better_end(terrain, robot)
    if not plan.feasible:
        return Tried(plan, None, "")
    outcome = sw.rollout(plan).outcome
    if not trials or outcome != "success":
        return Tried(plan, outcome, "")
    found = sw.trials(plan, trials, workers=1)
    ends = sorted((how, n) for how, n in found.outcomes.items() if how != "success")
    failures = ", ".join(f"{n} {how}" for how, n in ends)
    told = f"{found.successes} of {found.count}"
    return Tried(plan, outcome, f"{told} ({failures})" if failures else told)


def row_of(case: str, terrain: sw.Terrain, robot: sw.Robot, trials: int) -> list[str]:
    """The row of one case."""
    return tried(terrain, robot, trials).row(robot.name, case)


def with_payload(robot: sw.Robot) -> sw.Robot:
    """The robot with a fifth of its mass on top of its trunk."""
    top = robot.trunk.size[2] / 2 + 0.05
    load = {"mass": PAYLOAD * robot.mass, "place": [0.0, top]}
    data = robot.model_dump() | {"schema": "stairwright/robot/2", "payload": load}
    return sw.Robot.model_validate(data)


def cases(robot: sw.Robot) -> Iterator[tuple[str, sw.Terrain, sw.Robot]]:
    """The rows of one robot but for what is searched."""
    for name, (rise, tread) in CODES.items():
        for direction in ("up", "down"):
            flight = stair(rise, tread, STEPS, direction=direction, approach=2.0)
            yield f"{name} x {STEPS} {direction}", flight, robot
    curb = stair(0.15, 0.3, 1, approach=2.0)
    yield "curb 0.15", curb, robot
    yield "0.18/0.28 x 5 up, 20 % payload", stair(0.18, 0.28, 5, approach=2.0), with_payload(robot)


def highest(make: Callable[[int], sw.Terrain], robot: sw.Robot, most: int) -> int:
    """The largest number for which every smaller multiple of a coarse step and it are planned."""

    def possible(n: int) -> bool:
        return plan_led_by_better_end(make(n), robot, diagnose=False).feasible

    low, coarse = 0, 10
    while low + coarse <= most and possible(low + coarse):
        low += coarse
    while low < most and possible(low + 1):
        low += 1
    return low


def searched(robot: sw.Robot, kept: Kept) -> Iterator[tuple[str, sw.Terrain, sw.Robot]]:
    """The highest walls and the steepest ramp."""
    approach = 2.0 + robot.legs[0].reach

    def most(what: str, make: Callable[[int], sw.Terrain], limit: int) -> int:
        question = [what, robot.model_dump(mode="json"), make(10).model_dump(mode="json"), limit]
        return int(str(kept.answer(question, lambda: highest(make, robot, limit))))

    for direction in ("up", "down"):

        def wall(cm: int, direction: str = direction) -> sw.Terrain:
            return stair(cm / 100, 0.3, 1, direction=direction, approach=approach, platform=3.0)

        cm = most(f"wall {direction}", wall, 300)
        if cm:
            yield f"wall {cm / 100:.2f} m {direction}", wall(cm), robot

    def slope(degrees: int) -> sw.Terrain:
        return ramp(1.0, math.radians(degrees), approach=approach)

    degrees = most("ramp", slope, 45)
    if degrees:
        yield f"ramp {degrees} deg", slope(degrees), robot


def main() -> None:
    """Try everything, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=TRIALS, help="0 for none")
    parser.add_argument("--robots", default=",".join(ROBOTS))
    parser.add_argument("--keep", type=Path, help="folder of answers that are kept")
    parser.add_argument("--finish", action="store_true", help="no trials of rows not kept yet")
    parser.add_argument("--write", type=Path)
    options = parser.parse_args()
    kept = Kept(options.keep or Path(tempfile.mkdtemp(prefix="robots-")))
    rows: list[list[str]] = []
    for name in options.robots.split(","):
        robot = sw.load_robot(name)
        for case, terrain, loaded in (*cases(robot), *searched(robot, kept)):
            question: list[object] = [case, terrain.model_dump(mode="json")]
            question += [loaded.model_dump(mode="json"), options.trials]
            ask = partial(row_of, case, terrain, loaded)
            trials = 0 if options.finish and not kept.has(question) else options.trials
            row = kept.answer([*question[:-1], trials], partial(ask, trials))
            assert isinstance(row, list)
            if not trials and options.trials and row[2] == "yes, success":
                row[3] = "not run"
            rows.append([name, *row[1:]])
            print(rows[-1], flush=True)
    text = "\n".join([
        "# What each robot climbs", "",
        "Made by `python benchmarks/robots.py --write docs/robots.md`.", "",
        (__doc__ or "").split("\n\n", 2)[2].rsplit("\n\n", 1)[0], "",
        *summary(rows, options.trials), "",
        f"| {' | '.join(COLUMNS)} |",
        f"|{'---|' * len(COLUMNS)}",
        *(f"| {' | '.join(row)} |" for row in rows), "",
    ])  # fmt: skip
    if options.write:
        options.write.write_text(text)
    else:
        print(text)


def summary(rows: list[list[str]], trials: int) -> list[str]:
    """How many cases of each robot are planned, succeed, were tried, and hold in all trials."""
    names = ("robot", "cases", "planned", "rollout succeeds", "trials run", "all of them succeed")
    lines = [f"| {' | '.join(names)} |", "|---|---|---|---|---|---|"]
    for robot in dict.fromkeys(row[0] for row in rows):
        own = [row for row in rows if row[0] == robot]
        planned = sum(row[2].startswith("yes") for row in own)
        once = sum(row[2] == "yes, success" for row in own)
        run = sum(f" of {trials}" in row[3] for row in own)
        always = sum(row[3] == f"{trials} of {trials}" for row in own)
        lines.append(f"| {robot} | {len(own)} | {planned} | {once} | {run} | {always} |")
    return lines


if __name__ == "__main__":
    main()
