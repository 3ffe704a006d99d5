"""What workers do: functions of plain data that any process, here or elsewhere, can carry out."""

from __future__ import annotations

import contextlib
import gzip
import logging
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import orjson

from stairwright.documents import parse
from stairwright.errors import InputError
from stairwright.library import load_robot, robots
from stairwright.robot.description import Robot
from stairwright.storage.artefacts import Artefacts, name_of

from . import summaries
from .gauge import Gauge
from .live import Broadcast

if TYPE_CHECKING:
    from stairwright.export.table import Kind
    from stairwright.planning.plan import Plan

Question = Mapping[str, Any]
GENTLE = {"name": "warm-up", "points": [[-1.0, 0.0], [0.0, 0.0], [0.0, 0.04], [1.0, 0.04]]}
PLANNING_SHARE = 0.1  # of a rollout's progress, where it has to plan first


@dataclass(frozen=True)
class Product:
    """A finished document: kept among the artefacts, and what is worth knowing of it."""

    id: str
    digest: str
    size: int
    summary: Mapping[str, Any]
    content: bytes = b""  # a plan's JSON, for who waits for it
    plan: Product | None = None  # that a rollout made for itself


def solve(question: Question, artefacts: str | None) -> Product:
    """Plan; `question` has terrain and robot documents, friction, method and weights.

    Without a folder for artefacts the plan is not kept.

    Raises:
        InputError: If a value is bad.
    """
    return _keep_plan(_plan(question), artefacts)


def preview(question: Question) -> bytes:
    """The JSON of a plan that is neither certified nor kept; else as `solve`."""
    return _plan(question, certified=False).model_dump_json().encode()


def _plan(question: Question, certified: bool = True) -> Plan:
    from stairwright.planning.planner import plan

    asked = {key: question[key] for key in ("terrain", "friction", "method", "weights")}
    machine = _robot(orjson.dumps(question["robot"]))
    asked["timing"] = question.get("timing", "steady")
    return plan(robot=machine, certified=certified, tolerance=question.get("tolerance"), **asked)


@lru_cache(maxsize=16)
def _robot(document: bytes) -> Robot:
    """The same object for the same document: what is derived from it is derived once."""
    return parse(Robot, orjson.loads(document))


@lru_cache(maxsize=4)
def _artefacts(folder: str) -> Artefacts:
    """The same object for the same folder: it looks once whether that is there."""
    return Artefacts(Path(folder))


def _keep_plan(plan: Plan, artefacts: str | None) -> Product:
    content = plan.model_dump_json().encode()
    digest = _artefacts(artefacts).put(content) if artefacts else name_of(content)
    return Product(plan.id, digest, len(content), summaries.of_plan(plan), content)


def simulate(question: Question, artefacts: str, gauge_path: str, live_path: str) -> Product:
    """Roll a plan out.

    `question` has friction, controller, seed and perhaps a disturbance, and the plan's digest
    as ``plan_digest``, the whole ``plan``, or what `solve` takes as ``ask``. The series goes to
    the file at `live_path` while it grows.

    Raises:
        InputError: If a value is bad or the plan has nothing that could be carried out.
        Cancelled: If the gauge says so.
    """
    from stairwright.simulation.rollout import rollout

    gauge = Gauge(gauge_path)
    base = PLANNING_SHARE if question.get("ask") else 0.0
    plan = _plan_of(question, artefacts)
    gauge.report(base)

    def progress(share: float) -> None:
        gauge.report(base + (1.0 - base) * share)

    run = rollout(
        plan,
        friction=question["friction"],
        controller=question["controller"] or None,
        seed=question["seed"],
        disturbance=question.get("disturbance"),
        progress=progress,
        observe=Broadcast(live_path),
    )
    content = run.model_dump_json().encode()
    digest = _artefacts(artefacts).put(content)
    summary = summaries.of_rollout(run, plan)
    made = replace(_keep_plan(plan, artefacts), content=b"") if question.get("ask") else None
    return Product(run.id, digest, len(content), summary, plan=made)


def try_out(question: Question, artefacts: str, gauge_path: str, _: str) -> Product:
    """Roll a plan out many times under random deviations.

    `question` is that of `simulate` with ``count`` and ``ranges`` instead of a disturbance.

    Raises:
        InputError: If a value is bad or the plan has nothing that could be carried out.
        Cancelled: If the gauge says so.
    """
    from stairwright.simulation.trials import trials

    gauge = Gauge(gauge_path)
    plan = _plan_of(question, artefacts)
    found = trials(
        plan,
        question["count"],
        seed=question["seed"],
        ranges=question["ranges"],
        friction=question["friction"],
        controller=question["controller"] or None,
        progress=gauge.report,
    )
    content = found.model_dump_json().encode()
    digest = _artefacts(artefacts).put(content)
    summary = summaries.of_trials(found, plan)
    made = replace(_keep_plan(plan, artefacts), content=b"") if question.get("ask") else None
    return Product(found.id, digest, len(content), summary, plan=made)


def find_margins(question: Question, artefacts: str, gauge_path: str, _: str) -> Product:
    """Find delay and friction margin of a plan; `question` is that of `simulate`.

    Raises:
        InputError: If a value is bad or the plan has nothing that could be carried out.
        Cancelled: If the gauge says so.
    """
    from stairwright.simulation.robust_margins import robust_margins

    gauge = Gauge(gauge_path)
    plan = _plan_of(question, artefacts)
    found = robust_margins(
        plan,
        controller=question["controller"] or None,
        seed=question["seed"],
        progress=gauge.report,
    )
    content = found.model_dump_json(by_alias=True).encode()
    digest = _artefacts(artefacts).put(content)
    summary = summaries.of_margins(found, plan)
    made = replace(_keep_plan(plan, artefacts), content=b"") if question.get("ask") else None
    return Product(found.id, digest, len(content), summary, plan=made)


def _plan_of(question: Question, artefacts: str) -> Plan:
    from stairwright.planning.plan import Plan

    if question.get("ask"):
        plan = _plan(question["ask"])
    elif question.get("plan"):
        plan = Plan.model_validate(question["plan"])
    else:
        try:
            content = _artefacts(artefacts).content(question["plan_digest"])
        except FileNotFoundError:
            raise InputError("the plan is not stored any more", ("plan_id",)) from None
        plan = Plan.model_validate_json(content)
    return plan


def export(packed: bytes, kind: Kind, format_name: str, rate: float | None) -> bytes:
    """A plan, rollout or robot in another format; its gzipped JSON is given.

    Raises:
        InputError: If this document cannot be written in that format.
    """
    from stairwright.export.table import FORMATS

    content = gzip.decompress(packed)
    if format_name == "json" and rate is None:
        return content
    return FORMATS[kind][format_name].write(_document(kind, content), rate)


def _document(kind: Kind, content: bytes) -> Any:
    if kind == "plan":
        from stairwright.planning.plan import Plan

        return Plan.model_validate_json(content)
    if kind == "robot":
        return Robot.model_validate_json(content)
    from stairwright.simulation.result import Rollout

    return Rollout.model_validate(orjson.loads(content))


def warm_plans() -> None:
    """Import and load what the first plan would otherwise wait for."""
    with _logged():
        from stairwright.planning.planner import plan

        plan(GENTLE, robots()[0], method="path")
        plan(GENTLE, robots()[0], method="critical")


def rehearse() -> None:
    """A small plan in a worker, so that the first one that counts meets warm memory.

    Raises:
        Exception: Whatever would keep other plans from being answered too.
    """
    _plan(
        {"terrain": GENTLE, "robot": load_robot(robots()[0]).model_dump(mode="json"),
         "friction": 0.6, "method": "path", "weights": {}}
    )  # fmt: skip


def warm_rollouts() -> None:
    """The same for rollouts, and for the other robots."""
    with _logged():
        from stairwright.planning.planner import plan
        from stairwright.simulation.rollout import rollout

        for robot in robots():
            rollout(plan(GENTLE, robot, method="path"))
            plan(GENTLE, robot, method="critical")


@contextlib.contextmanager
def _logged() -> Iterator[None]:
    """What fails while warming up will fail again, and be answered, where it is needed."""
    try:
        yield
    except Exception:
        logging.getLogger(__name__).exception("warming up failed")
