"""Many rollouts of one plan under random deviations: how often does it succeed?"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from multiprocessing import get_context
from typing import Any, Literal

import numpy as np
from pydantic import Field

from stairwright.arguments import MOST_SEED, as_friction, as_model, as_whole
from stairwright.control.settings import ControllerSettings, StoredSettings, parse_settings
from stairwright.documents import Model, content_hash, parse
from stairwright.planning.plan import Plan
from stairwright.resources import all_cores

from .disturbance import Disturbance
from .ranges import Ranges, chosen_ranges, draw
from .result import Outcome
from .rollout import rollout
from .run import runs_natively

Job = tuple[int, Disturbance]  # seed and deviations

MOST_TRIALS = 100_000
MOST_WORKERS = 1024
SUSPECT = 0.6  # of pairs of a failed and a good trial
CONFIDENCE_Z = 1.959964  # two-sided 95 %


class Trial(Model):
    """One rollout of the set."""

    seed: int
    disturbance: Disturbance
    outcome: Outcome
    reason: str
    pitch_error_max: float
    link_contacts: int


class Trials(Model):
    """A set of randomised rollouts (``stairwright/trials/1``)."""

    schema_: Literal["stairwright/trials/1"] = Field("stairwright/trials/1", alias="schema")
    id: str = Field(description="hash of the question")
    plan_id: str
    terrain_hash: str
    robot_hash: str
    friction: float = Field(description="nominal true friction; each trial adds its own")
    seed: int
    controller: StoredSettings
    ranges: Ranges
    count: int
    successes: int
    rate: float = Field(description="share of successes")
    wilson: tuple[float, float] = Field(description="95 % confidence interval of the rate")
    clopper_pearson: tuple[float, float] = Field(description="95 % interval, exact")
    outcomes: dict[str, int]
    suspects: dict[str, float] = Field(
        {},
        description="deviations that are larger where trials failed: how often a failed one had "
        "more of it than one that succeeded",
    )
    trials: list[Trial]


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
    plan = as_model(Plan, plan, "plan")
    n, seed = (
        as_whole(n, 1, MOST_TRIALS, "trials"),
        as_whole(seed, 0, MOST_SEED - MOST_TRIALS, "seed"),
    )
    workers = all_cores() if workers is None else as_whole(workers, 1, MOST_WORKERS, "workers")
    settings, limits = parse_settings(controller), chosen_ranges(ranges, bundle)
    nominal = plan.friction if friction is None else as_friction(friction)
    draws = draw(limits, n, seed)
    jobs = [(seed + i, deviation) for i, deviation in enumerate(draws)]
    results = []
    for result in _share(plan, nominal, settings, jobs, workers):
        results.append(result)
        if progress is not None:
            progress(len(results) / n)
    successes = sum(result.outcome == "success" for result in results)
    asked = [plan.id, nominal, settings.model_dump(), limits.model_dump(), n, seed]
    return Trials(
        id="t-" + content_hash(asked).removeprefix("sha256:"),
        plan_id=plan.id,
        terrain_hash=plan.terrain_hash,
        robot_hash=plan.robot_hash,
        friction=nominal,
        seed=seed,
        controller=settings,
        ranges=limits,
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


def wilson(successes: int, n: int) -> tuple[float, float]:
    """Wilson's 95 % score interval of a rate."""
    z2 = CONFIDENCE_Z**2
    p = successes / n
    middle = (p + z2 / (2 * n)) / (1 + z2 / n)
    half = CONFIDENCE_Z / (1 + z2 / n) * math.sqrt(p * (1 - p) / n + z2 / (4 * n * n))
    return max(0.0, middle - half), min(1.0, middle + half)


def clopper_pearson(successes: int, n: int) -> tuple[float, float]:
    """Clopper and Pearson's exact 95 % interval of a rate."""
    from scipy.stats import beta

    low = float(beta.ppf(0.025, successes, n - successes + 1)) if successes else 0.0
    high = float(beta.ppf(0.975, successes + 1, n - successes)) if successes < n else 1.0
    return low, high


def _share(
    plan: Plan, friction: float, settings: ControllerSettings, jobs: list[Job], workers: int
) -> Iterator[Trial]:
    """Results of all `jobs`, in order.

    The native loop runs without Python's lock, so threads share the work without any start-up
    cost; other controllers are Python and need processes.
    """
    if workers == 1:
        yield from (_one(plan, friction, settings, job) for job in jobs)
        return
    pool: Executor
    work: Callable[[Job], Trial]
    if runs_natively(settings):
        pool = ThreadPoolExecutor(workers)
        work = partial(_one, plan, friction, settings)
    else:
        pool = ProcessPoolExecutor(
            workers,
            mp_context=get_context("spawn"),
            initializer=_start_worker,
            initargs=(plan.model_dump(mode="json"), friction, settings.model_dump()),
        )
        work = _one_of_worker
    try:
        yield from pool.map(work, jobs)
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


_shared: list[tuple[Plan, float, ControllerSettings]] = []


def _start_worker(plan: dict[str, Any], friction: float, settings: dict[str, Any]) -> None:
    """What all rollouts of a process share: parsed once, not sent with each."""
    _shared[:] = [(parse(Plan, plan), friction, parse_settings(settings))]


def _one_of_worker(job: Job) -> Trial:
    return _one(*_shared[0], job)


def _one(plan: Plan, friction: float, settings: ControllerSettings, job: Job) -> Trial:
    seed, disturbance = job
    run = rollout(
        plan,
        friction=friction,
        controller=settings,
        seed=seed,
        disturbance=disturbance,
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
