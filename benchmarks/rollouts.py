"""How fast rollouts are, and how the two forms of the controller compare on the paper's terrains.

    python benchmarks/rollouts.py [--quick] [--json FILE]

The limit is raw stepping: the same model through the same states, with the torques of a recorded
rollout and nothing else. The peer is the same controller in numpy with its QP in Clarabel through
qpsolvers. Times are CPU time of this process, which other programs on the machine disturb less;
many rollouts at once are wall-clock time.
"""

from __future__ import annotations

import math
import statistics
import time
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray
from report import Row, command, percentile

import stairwright as sw
from stairwright.control.settings import parse_settings
from stairwright.planning.plan import Plan
from stairwright.simulation.disturbance import Disturbance
from stairwright.simulation.physics import CONTROL_STEPS
from stairwright.simulation.run import Run
from stairwright.simulation.trials import all_cores, trials

TERRAIN, ROBOT = "single-stair-036", "a1_wheeled"
MANY = 64
PAPER = (
    "ramp-30deg-025",
    "single-stair-030",
    "single-stair-036",
    "three-stairs-up",
    "three-stairs-up-down",
)


def begin(plan: Plan, hz: float = 100.0, **settings: Any) -> Run:
    """A rollout that is ready to run."""
    return Run(plan, plan.friction, parse_settings(settings), Disturbance(), 0, hz)


def cpu(task: Callable[[], object]) -> float:
    """CPU time of `task` [s]."""
    begun = time.process_time()
    task()
    return time.process_time() - begun


def replay(run: Run, torques: NDArray[np.float64]) -> None:
    """Nothing but stepping, with known torques."""
    model, data, ctrl, step = run.physics.model, run.data, run.data.ctrl, mujoco.mj_step
    for row in torques:
        ctrl[:] = row
        step(model, data, CONTROL_STEPS)


def loop(repeat: int) -> list[Row]:
    """Raw stepping, the closed loop and the plain controller, each on the same states."""
    plan = sw.plan(TERRAIN, ROBOT)
    recorded = begin(plan, hz=500.0)
    recorded.simulate(None)
    torques = recorded.recorder.series().torque
    simulated = len(torques) * recorded.dt
    closed, known, raw, plain = [], [], [], []
    for k in range(repeat):  # in turn, so that a disturbance of the machine meets all alike
        run = begin(plan)
        closed.append(cpu(lambda r=run: r.simulate(None)) / simulated)
        run = begin(plan, sensing="ideal")
        known.append(cpu(lambda r=run: r.simulate(None)) / run.time)
        run = begin(plan)
        raw.append(cpu(lambda r=run: replay(r, torques)) / simulated)
        if k < max(1, repeat // 5):
            run = begin(plan, solver="clarabel")
            plain.append(cpu(lambda r=run: r.simulate(None)) / simulated)
    control = statistics.median(plain) - statistics.median(raw)
    own = max(statistics.median(closed) - statistics.median(raw), 1e-9)
    work = f"{simulated:.1f} s of {TERRAIN}, 1 ms physics, 500 Hz control"
    ours = statistics.median(closed)

    def row(name: str, seconds: list[float], note: str) -> Row:
        scaled = [1e3 * 10.0 * s for s in seconds]
        median = statistics.median(scaled)
        faster = f"{1 / statistics.median(seconds):.0f} x real time"
        ratio = statistics.median(seconds) / ours
        text = f"{faster}; {note}" if note else faster
        return Row(work, name, median, percentile(scaled, 0.95), "ms per 10 s", ratio, note=text)

    def share(seconds: list[float]) -> str:
        least = statistics.median(r / s for r, s in zip(raw, seconds, strict=True))
        return f"{least:.2f} of raw stepping's speed"

    return [
        row("stairwright, by the robot's own sensors", closed, share(closed)),
        row("stairwright, its state known", known, share(known)),
        row("raw mj_step, recorded torques", raw, "the limit"),
        row("numpy and Clarabel via qpsolvers", plain,
            f"its control alone takes {control / own:.0f} x Stairwright's"),
    ]  # fmt: skip


def whole(repeat: int) -> Row:
    """`sw.rollout` from call to answer: model, tracks, loop, series and metrics."""
    plan = sw.plan(TERRAIN, ROBOT)
    took, simulated = [], 1.0
    for _ in range(repeat):
        begun = time.process_time()
        simulated = sw.rollout(plan).metrics.duration
        took.append(1e3 * (time.process_time() - begun))
    note = f"{1e3 * simulated / statistics.median(took):.0f} x real time"
    work = f"sw.rollout, {simulated:.1f} s of {TERRAIN}"
    name = "stairwright, all included"
    return Row(work, name, statistics.median(took), percentile(took, 0.95), ratio=1.0, note=note)


def many(count: int) -> list[Row]:
    """Randomised rollouts one after another and on all cores, wall-clock."""
    plan = sw.plan(TERRAIN, ROBOT, 0.7)
    cores = all_cores()
    seconds: dict[int, list[float]] = {1: [], cores: []}
    good = 0
    for workers in (cores, 1, cores, 1):
        begun = time.perf_counter()
        good = trials(plan, count, workers=workers, friction=0.7).successes
        seconds[workers].append(time.perf_counter() - begun)
    best = {workers: min(took) for workers, took in seconds.items()}
    work, share = f"{count} randomised rollouts", f"{good} of {count}"
    gain = f"{best[1] / best[cores]:.2f} x as fast as one after another"
    return [
        Row(work, f"stairwright, {cores} cores", best[cores], None, "s", 1.0, share, gain),
        Row(work, "stairwright, one core", best[1], None, "s", best[1] / best[cores], share),
    ]


def forms(quick: bool) -> Iterator[Row]:
    """Outcomes of both forms of the controller on the paper's terrains, plans of two methods."""
    for terrain in PAPER[:1] if quick else PAPER:
        for robot in sw.robots()[:1] if quick else sw.robots():
            for method in ("path", "critical"):
                plan = sw.plan(terrain, robot, method=method)
                for form in ("contact", "paper"):
                    yield outcome(plan, f"{terrain}, {robot}, {method} plan", {"form": form})


def outcome(plan: Plan, work: str, settings: Mapping[str, Any]) -> Row:
    """One rollout: largest pitch error, and how it ended."""
    name = f"form {settings['form']}"
    if len(plan.poses) < 2:
        return Row(work, name, note="no plan")
    run = sw.rollout(plan, controller=settings)
    error = math.degrees(run.metrics.pitch_error_max)
    note = "" if run.success else f"{run.outcome}: {run.reason}"
    return Row(work, name, error, unit="deg", solved="yes" if run.success else "no", note=note)


def run(quick: bool = False) -> list[Row]:
    """All rows."""
    repeat = 3 if quick else 15
    rows = [*loop(repeat), whole(repeat), *many(8 if quick else MANY)]
    return [*rows, *forms(quick)]


if __name__ == "__main__":
    command(__doc__, run)
