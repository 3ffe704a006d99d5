"""The same plans under the same controller in other physics engines, verdict by verdict.

    python benchmarks/engines.py [--count 12] [--first 0] [--friction 0.6] [--robots R ...]
        [--workers N] [--quick] [--json FILE]

Presets and random profiles of `profiles.py` are planned, and each feasible plan is carried out in
MuJoCo, as the product does it, in Drake and in Bullet. Loop, controller (in numpy where the
engine is not MuJoCo), sensing (ideal), the plan's progress and the verdict are the product's;
engine, contact model and its solver are not. Each case is told as it is done; the table holds
verdicts and the largest pitch errors, and what differs is named below it.
"""

from __future__ import annotations

import argparse
import statistics
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from multiprocessing import get_context
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from profiles import random_profile
from report import Row, percentile, publish

import stairwright as sw
from stairwright.control.settings import ControllerSettings
from stairwright.planning.plan import Plan
from stairwright.robot.mujoco_model import TIMESTEP
from stairwright.simulation.disturbance import Disturbance
from stairwright.simulation.physics import CONTROL_STEPS
from stairwright.simulation.run import Run

Floats = NDArray[np.float64]

ROBOTS = ("a1_wheeled", "go2w")
SETTINGS = ControllerSettings(sensing="ideal")


class Engine:
    """Another engine's `stairwright.simulation.physics.Physics`."""

    source, timestep = "", TIMESTEP

    def __init__(self, plan: Plan, friction: float, world_of: Any) -> None:
        self.terrain = plan.terrain
        self._world = world = world_of(plan.robot_description, plan.terrain, friction)
        self.state = SimpleNamespace(
            time=0.0, qpos=world.qpos, qvel=world.qvel, ctrl=world.ctrl, sensordata=np.zeros(16)
        )

    def place(self, qpos: Floats) -> None:
        self._world.qpos[:] = qpos
        self._world.place()

    def advance(self) -> None:
        self._world.advance(CONTROL_STEPS)
        self.state.time += CONTROL_STEPS * TIMESTEP

    def touches(self) -> tuple[bool, dict[str, float]]:
        return False, self._world.loads()

    def wheels(self) -> Floats:
        return self._world.wheel_centres()

    def broken(self) -> bool:
        return False


@dataclass(frozen=True)
class Told:
    """What one engine says of one plan: its verdict, and the pitch's errors [rad]."""

    outcome: str
    reason: str
    pitch_max: float
    pitch_rms: float


@dataclass(frozen=True)
class Case:
    """One plan and what each engine says of it."""

    robot: str
    terrain: str
    preset: bool
    told: dict[str, Told]


def engines() -> dict[str, str]:
    """The engines that are installed by name, and the module of each world."""
    known = {"Drake": ("pydrake", "drake_world"), "Bullet": ("pybullet", "bullet_world")}
    return {name: own for name, (package, own) in known.items() if find_spec(package)}


def case(friction: float, robot: str, terrain: str | int) -> Case | None:
    """A preset's name or a random profile's number, carried out everywhere; None without a plan."""
    ground = random_profile(terrain)[1] if isinstance(terrain, int) else sw.load_terrain(terrain)
    plan = sw.plan(ground, robot, friction)
    if not plan.feasible:
        return None
    told = {"MuJoCo": _told(sw.rollout(plan, controller=SETTINGS, keep_plan=False))}
    for name, module in engines().items():
        engine = Engine(plan, friction, import_module(module).World)
        run = Run(plan, friction, SETTINGS, Disturbance(), 0, 100.0, engine)
        told[name] = _told(run.result(run.simulate(None), keep_plan=False))
    return Case(robot, ground.name, isinstance(terrain, str), told)


def _told(run: Any) -> Told:
    m = run.metrics
    return Told(run.outcome, run.reason, m.pitch_error_max, m.pitch_error_rms)


def summary(cases: list[Case]) -> Iterator[Row]:
    """A row for each robot and engine, presets and random profiles apart."""
    for preset in (True, False):
        for robot in dict.fromkeys(c.robot for c in cases):
            own = [c for c in cases if c.robot == robot and c.preset == preset]
            for engine in dict.fromkeys(name for c in own for name in c.told):
                beside = [(c.told[engine], c.told["MuJoCo"]) for c in own]
                same = sum(here.outcome == there.outcome for here, there in beside)
                errors = [1e3 * here.pitch_max for here, _ in beside]
                ratios = [here.pitch_max / there.pitch_max for here, there in beside]
                good = sum(here.outcome == "success" for here, _ in beside)
                yield Row(
                    f"{robot}, {'presets' if preset else 'random profiles'}",
                    engine,
                    statistics.median(errors),
                    percentile(errors, 0.95),
                    "mrad",
                    statistics.median(ratios),
                    f"{good} of {len(own)}",
                    "" if engine == "MuJoCo" else f"verdict as MuJoCo's: {same} of {len(own)}",
                )


def differences(cases: list[Case]) -> Iterator[str]:
    """A sentence for each plan that is not a success everywhere."""
    for c in cases:
        if {t.outcome for t in c.told.values()} != {"success"}:
            words = "; ".join(f"{name}: {t.outcome}, {t.reason}" for name, t in c.told.items())
            yield f"{c.robot}, {c.terrain}: {words}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=12, help="random profiles")
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument("--friction", type=float, default=0.6)
    parser.add_argument("--robots", nargs="*", default=ROBOTS)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--quick", action="store_true", help="one robot, two terrains")
    parser.add_argument("--json", help="write machine and rows to this file too")
    given = parser.parse_args()
    robots, numbers = given.robots, range(given.first, given.first + given.count)
    terrains: list[str | int] = [*sw.terrains(), *numbers]
    if given.quick:
        robots, terrains = robots[:1], ["single-stair-030", given.first]
    asked = [(robot, terrain) for robot in robots for terrain in terrains]
    cases = []
    with ProcessPoolExecutor(given.workers, mp_context=get_context("spawn")) as pool:
        for done in pool.map(partial(case, given.friction), *zip(*asked, strict=True)):
            if done is not None:
                cases.append(done)
                told = (f"{n} {t.outcome} {1e3 * t.pitch_max:.1f}" for n, t in done.told.items())
                print(f"{done.robot}, {done.terrain}:", ", ".join(told), file=sys.stderr)
    missing = sorted({"Drake", "Bullet"} - set(engines()))
    rows = [*summary(cases), *(Row("all", name, note="not installed") for name in missing)]
    publish(rows, given.json)
    print(f"\n{len(asked) - len(cases)} of {len(asked)} have no plan.")
    print(*differences(cases), sep="\n")


if __name__ == "__main__":
    main()
