"""Many rollouts of one plan under random deviations: how often does it succeed?"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from multiprocessing import get_context
from typing import Any

import numpy as np

from stairwright.arguments import MOST_SEED, as_friction, as_model, as_whole
from stairwright.control.settings import ControllerSettings, parse_settings
from stairwright.documents import content_hash
from stairwright.planning.plan import Plan
from stairwright.resources import all_cores

from .disturbance import Disturbance
from .intervals import clopper_pearson, wilson
from .ranges import Ranges, chosen_ranges, draw
from .rollout import rollout
from .run import runs_natively
from .trials_result import MOST_TRIALS, Trial, Trials

Job = tuple[int, Disturbance]  # seed and deviations

MOST_WORKERS = 1024
SUSPECT = 0.6  # of pairs of a failed and a good trial


def trials(
    plan: Plan | Mapping[str, Any],
    n: int = 100,
    seed: int = 0,
    ranges: Mapping[str, Any] | Ranges | None = None,
    workers: int | None = None,
    friction: float | None = None,
    controller: Mapping[str, Any] | ControllerSettings | None = None,
    progress: Callable[[float], None] | None = None,
    bundle: str | None = None,
) -> Trials:
    """Roll `plan` out `n` times under random deviations.

    The same seed gives the same trials, whatever the number of workers.

    Args:
        plan: What to carry out.
        n: Number of rollouts, 1..100,000.
        seed: Of the deviations and of each rollout's sensor noise.
        ranges: Where the deviations come from, see `Ranges`.
        workers: How many share the work; as many as there are cores by default.
        friction: Nominal true friction; the plan's by default.
        controller: Settings by name, see `ControllerSettings`.
        progress: Called with the share done, 0..1; may raise `Cancelled`.
        bundle: Instead of `ranges` the name of some: usual, laboratory or field.

    Raises:
        InputError: If an argument is bad.
    """
    asked = TrialSet.of(plan, n, seed, ranges, friction, controller, bundle)
    workers = all_cores() if workers is None else as_whole(workers, 1, MOST_WORKERS, "workers")
    results = []
    for result in _share(asked, workers):
        results.append(result)
        if progress is not None:
            progress(len(results) / asked.count)
    return asked.summary(results)


@dataclass(frozen=True)
class TrialSet:
    """A whole question of `trials`; any part of it can be carried out by itself, anywhere."""

    plan: Plan
    friction: float
    controller: ControllerSettings
    ranges: Ranges
    count: int
    seed: int

    @classmethod
    def of(
        cls,
        plan: Plan | Mapping[str, Any],
        n: int,
        seed: int = 0,
        ranges: Mapping[str, Any] | Ranges | None = None,
        friction: float | None = None,
        controller: Mapping[str, Any] | ControllerSettings | None = None,
        bundle: str | None = None,
    ) -> TrialSet:
        """Fill in defaults; arguments are those of `trials`.

        Raises:
            InputError: If an argument is bad.
        """
        plan = as_model(Plan, plan, "plan")
        return cls(
            count=as_whole(n, 1, MOST_TRIALS, "trials"),
            seed=as_whole(seed, 0, MOST_SEED - MOST_TRIALS, "seed"),
            controller=parse_settings(controller),
            ranges=chosen_ranges(ranges, bundle),
            friction=plan.friction if friction is None else as_friction(friction),
            plan=plan,
        )

    @property
    def arguments(self) -> tuple[Any, ...]:
        """What `of` makes the same from, as plain data: for other processes."""
        plan, ranges = self.plan.model_dump(mode="json"), self.ranges.model_dump(mode="json")
        settings = self.controller.model_dump(mode="json")
        return plan, self.count, self.seed, ranges, self.friction, settings

    @cached_property
    def jobs(self) -> list[Job]:
        """Seed and deviations of every trial, in order."""
        draws = draw(self.ranges, self.count, self.seed)
        return [(self.seed + i, deviation) for i, deviation in enumerate(draws)]

    def carry_out(self, job: Job, progress: Callable[[float], None] | None = None) -> Trial:
        """One of `jobs`; `progress` as of `rollout`.

        Raises:
            InputError: If the plan has no poses.
        """
        seed, disturbance = job
        run = rollout(
            self.plan,
            friction=self.friction,
            controller=self.controller,
            seed=seed,
            disturbance=disturbance,
            progress=progress,
            record_hz=5.0,
            keep_plan=False,
        )
        return Trial(
            seed=seed,
            disturbance=disturbance,
            outcome=run.outcome,
            reason=run.reason,
            pitch_error_max=run.metrics.pitch_error_max,
            link_contacts=run.metrics.link_contacts,
        )

    def summary(self, results: list[Trial]) -> Trials:
        """What came of all `jobs`, in their order."""
        n = self.count
        successes = sum(result.outcome == "success" for result in results)
        settings, limits = self.controller.model_dump(), self.ranges.model_dump()
        asked = [self.plan.id, self.friction, settings, limits, n, self.seed]
        return Trials(
            id="t-" + content_hash(asked).removeprefix("sha256:"),
            plan_id=self.plan.id,
            terrain_hash=self.plan.terrain_hash,
            robot_hash=self.plan.robot_hash,
            friction=self.friction,
            seed=self.seed,
            controller=self.controller,
            ranges=self.ranges,
            count=n,
            successes=successes,
            rate=successes / n,
            wilson=wilson(successes, n),
            clopper_pearson=clopper_pearson(successes, n),
            outcomes=dict(Counter(result.outcome for result in results)),
            suspects=suspects(results),
            trials=results,
        )


def suspects(results: Sequence[Trial]) -> dict[str, float]:
    """By deviation: how often a failed trial had more of it than one that succeeded.

    The Mann-Whitney statistic over the product of the numbers, of sizes without sign; only what
    stands out (above `SUSPECT`), the most striking first.
    """
    good = [trial.disturbance for trial in results if trial.outcome == "success"]
    bad = [trial.disturbance for trial in results if trial.outcome != "success"]
    found: dict[str, float] = {}
    if not good or not bad:
        return found
    for name in Disturbance.model_fields:
        a, b = (np.array([one.size(name) for one in group]) for group in (bad, good))
        more = np.mean(np.sign(a[:, None] - b[None, :]) / 2 + 0.5)
        if more > SUSPECT:
            found[name] = round(float(more), 3)
    return dict(sorted(found.items(), key=lambda item: -item[1]))


def _share(asked: TrialSet, workers: int) -> Iterator[Trial]:
    """Results of all jobs, in order.

    The native loop runs without Python's lock, so threads share the work without any start-up
    cost; other controllers are Python and need processes.
    """
    if workers == 1:
        yield from map(asked.carry_out, asked.jobs)
        return
    pool: Executor
    work: Callable[[Job], Trial]
    if runs_natively(asked.controller):
        pool = ThreadPoolExecutor(workers)
        work = asked.carry_out
    else:
        pool = ProcessPoolExecutor(
            workers,
            mp_context=get_context("spawn"),
            initializer=_start_worker,
            initargs=asked.arguments,
        )
        work = _one_of_worker
    try:
        yield from pool.map(work, asked.jobs)
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


_shared: list[TrialSet] = []


def _start_worker(*arguments: Any) -> None:
    """What all rollouts of a process share: parsed once, not sent with each."""
    _shared[:] = [TrialSet.of(*arguments)]


def _one_of_worker(job: Job) -> Trial:
    return _shared[0].carry_out(job)
