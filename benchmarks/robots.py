"""What each robot climbs: stairs of the building codes, walls, ramps, curbs, with a payload.

    python benchmarks/robots.py [--trials 29] [--robots go2w,b2w] [--write docs/robots.md]

A case counts where the plan is certified and its rollout succeeds. 29 of 29 randomised trials
support a reliability of 90 % with 95 % confidence (0.9^29 = 0.047; the practice of ASTM's tests of
response robots); without trials the column is empty. Friction 0.6. Walls are searched on a grid of
1 cm, ramps of one degree. All of it is statics and simulation: no hardware has run it.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import stairwright as sw
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
STEPS = 5
PAYLOAD = 0.2  # of the robot's mass


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
            return [robot, case, "no", "", self.plan.problem.message.split(":")[0], ""]
        binding = self.plan.binding
        assert binding is not None
        units = {"torque": "Nm", "wheel_torque": "Nm", "joint_limit": "rad", "friction": ""}
        unit = units.get(binding.quantity, "m")
        least = f"{binding.quantity.replace('_', ' ')} {binding.value:.3g} {unit}".strip()
        knees = self.plan.knees
        bend = f"{knees.front}, {knees.rear}" if knees else ""
        return [robot, case, f"yes, {self.outcome}", self.trials, least, bend]


def tried(terrain: sw.Terrain, robot: sw.Robot, trials: int) -> Tried:
    """Plan, rollout, and randomised trials where it succeeds."""
    plan = sw.plan(terrain, robot, 0.6)
    if not plan.feasible:
        return Tried(plan, None, "")
    outcome = sw.rollout(plan).outcome
    if not trials or outcome != "success":
        return Tried(plan, outcome, "")
    found = sw.trials(plan, trials)
    return Tried(plan, outcome, f"{found.successes} of {found.count}")


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
    low, coarse = 0, 10
    while low + coarse <= most and sw.plan(make(low + coarse), robot, 0.6).feasible:
        low += coarse
    while low < most and sw.plan(make(low + 1), robot, 0.6).feasible:
        low += 1
    return low


def searched(robot: sw.Robot) -> Iterator[tuple[str, sw.Terrain, sw.Robot]]:
    """The highest walls and the steepest ramp."""
    approach = 2.0 + robot.legs[0].reach
    for direction in ("up", "down"):

        def wall(cm: int, direction: str = direction) -> sw.Terrain:
            return stair(cm / 100, 0.3, 1, direction=direction, approach=approach, platform=3.0)

        cm = highest(wall, robot, 300)
        if cm:
            yield f"wall {cm / 100:.2f} m {direction}", wall(cm), robot

    def slope(degrees: int) -> sw.Terrain:
        return ramp(1.0, math.radians(degrees), approach=approach)

    degrees = highest(slope, robot, 45)
    if degrees:
        yield f"ramp {degrees} deg", slope(degrees), robot


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=0)
    parser.add_argument("--robots", default=",".join(ROBOTS))
    parser.add_argument("--write", type=Path)
    options = parser.parse_args()
    rows = []
    for name in options.robots.split(","):
        robot = sw.load_robot(name)
        for case, terrain, loaded in (*cases(robot), *searched(robot)):
            rows.append(tried(terrain, loaded, options.trials).row(name, case))
            print(rows[-1], flush=True)
    text = "\n".join([
        "# What each robot climbs", "",
        "Made by `python benchmarks/robots.py --write docs/robots.md`.", "",
        (__doc__ or "").split("\n\n", 2)[2],
        "| robot | case | planned, rollout | trials | least margin, or what stops it | knees |",
        "|---|---|---|---|---|---|",
        *(f"| {' | '.join(row)} |" for row in rows), "",
    ])  # fmt: skip
    if options.write:
        options.write.write_text(text)
    else:
        print(text)


if __name__ == "__main__":
    main()
