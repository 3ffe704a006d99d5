"""What workers do: functions of plain data that any process, here or elsewhere, can carry out."""

from __future__ import annotations

import gzip
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import orjson

from stairwright.documents import parse
from stairwright.errors import InputError
from stairwright.robot.description import Robot
from stairwright.storage.artefacts import Artefacts, name_of

from . import summaries
from .gauge import Gauge
from .live import Broadcast, append

if TYPE_CHECKING:
    from stairwright.export.table import Kind
    from stairwright.planning.plan import Plan
    from stairwright.simulation.margins_result import RobustMargins
    from stairwright.simulation.record import Recorder
    from stairwright.simulation.result import Rollout
    from stairwright.simulation.trials_result import Trials

Question = Mapping[str, Any]
PLANNING_SHARE = 0.1  # of a rollout's progress, where it has to plan first


@dataclass(frozen=True)
class Product:
    """A finished document: kept among the artefacts, and what is worth knowing of it."""

    id: str
    digest: str
    size: int
    summary: Mapping[str, Any]
    content: bytes = b""  # its JSON until it is kept; of a plan for who waits for it, too
    plan: Product | None = None  # that a rollout made for itself


def solve(question: Question, artefacts: str | None) -> Product:
    """Plan; `question` has terrain and robot documents, friction, method and weights.

    Without a folder for artefacts the plan is not kept.

    Raises:
        InputError: If a value is bad.
    """
    made = product_of_plan(_plan(question))
    if artefacts:
        _artefacts(artefacts).put(made.content)
    return made


def preview(question: Question) -> bytes:
    """The JSON of a plan that is not kept, and comes sooner; else as `solve`.

    Key poses are not certified, and of an infeasible path it is not found out what would open it.
    """
    return _plan(question, complete=False).model_dump_json().encode()


def _plan(question: Question, complete: bool = True) -> Plan:
    from stairwright.planning.planner import plan

    asked = {key: question[key] for key in ("terrain", "friction", "method", "weights")}
    machine = _robot(orjson.dumps(question["robot"]))
    asked["timing"] = question.get("timing", "steady")
    asked["facing"] = question.get("facing", "forward")
    asked["tolerance"] = question.get("tolerance")
    return plan(robot=machine, certified=complete, diagnose=complete, **asked)


@lru_cache(maxsize=16)
def _robot(document: bytes) -> Robot:
    """The same object for the same document: what is derived from it is derived once."""
    return parse(Robot, orjson.loads(document))


@lru_cache(maxsize=4)
def _artefacts(folder: str) -> Artefacts:
    """The same object for the same folder: it looks once whether that is there."""
    return Artefacts(Path(folder))


def simulate(question: Question, artefacts: str, gauge_path: str, live_path: str) -> Product:
    """Roll a plan out.

    `question` has friction, controller, seed and perhaps a disturbance, and the plan's digest
    as ``plan_digest``, the whole ``plan``, or what `solve` takes as ``ask``. The series goes to
    the file at `live_path` while it grows.

    Raises:
        InputError: If a value is bad or the plan has nothing that could be carried out.
        Cancelled: If the gauge says so.
    """
    gauge = Gauge(gauge_path)
    base = PLANNING_SHARE if question.get("ask") else 0.0
    plan = plan_of(question, _artefacts(artefacts))
    gauge.report(base)

    def progress(share: float) -> None:
        gauge.report(base + (1.0 - base) * share)

    found = rolled_out(plan, question, progress, Broadcast(partial(append, live_path)))
    return keep(found, _artefacts(artefacts))


def rolled_out(
    plan: Plan,
    question: Question,
    progress: Callable[[float], None],
    observe: Callable[[Recorder], None],
) -> Product:
    """The rollout that `simulate` is asked for, not kept yet."""
    from stairwright.simulation.rollout import rollout

    run = rollout(
        plan,
        friction=question["friction"],
        controller=question["controller"] or None,
        seed=question["seed"],
        disturbance=question.get("disturbance"),
        progress=progress,
        observe=observe,
    )
    made = product_of_plan(plan) if question.get("ask") else None
    return _product(run, summaries.of_rollout(run, plan), made)


def try_out(question: Question, artefacts: str, gauge_path: str, _: str) -> Product:
    """Roll a plan out many times under random deviations.

    `question` is that of `simulate` with ``count`` and ``ranges`` instead of a disturbance.

    Raises:
        InputError: If a value is bad or the plan has nothing that could be carried out.
        Cancelled: If the gauge says so.
    """
    from stairwright.simulation.trials import trials

    gauge = Gauge(gauge_path)
    plan = plan_of(question, _artefacts(artefacts))
    found = trials(
        plan,
        question["count"],
        seed=question["seed"],
        ranges=question["ranges"],
        friction=question["friction"],
        controller=question["controller"] or None,
        progress=gauge.report,
    )
    return keep(tried(found, plan, question), _artefacts(artefacts))


def tried(found: Trials, plan: Plan, question: Question) -> Product:
    """The trials that `try_out` is asked for, not kept yet."""
    made = product_of_plan(plan) if question.get("ask") else None
    return _product(found, summaries.of_trials(found, plan), made)


def find_margins(question: Question, artefacts: str, gauge_path: str, _: str) -> Product:
    """Find delay and friction margin of a plan; `question` is that of `simulate`.

    Raises:
        InputError: If a value is bad or the plan has nothing that could be carried out.
        Cancelled: If the gauge says so.
    """
    plan = plan_of(question, _artefacts(artefacts))
    found = margins_found(plan, question, Gauge(gauge_path).report)
    return keep(found, _artefacts(artefacts))


def margins_found(plan: Plan, question: Question, progress: Callable[[float], None]) -> Product:
    """The margins that `find_margins` is asked for, not kept yet."""
    from stairwright.simulation.robust_margins import robust_margins

    found = robust_margins(
        plan,
        controller=question["controller"] or None,
        seed=question["seed"],
        progress=progress,
    )
    made = product_of_plan(plan) if question.get("ask") else None
    return _product(found, summaries.of_margins(found, plan), made)


def _product(
    found: Rollout | Trials | RobustMargins, summary: Mapping[str, Any], plan: Product | None
) -> Product:
    content = found.model_dump_json(by_alias=True).encode()
    return Product(found.id, name_of(content), len(content), summary, content, plan)


def product_of_plan(plan: Plan) -> Product:
    """A plan, not kept yet."""
    content = plan.model_dump_json().encode()
    return Product(plan.id, name_of(content), len(content), summaries.of_plan(plan), content)


def keep(product: Product, artefacts: Artefacts) -> Product:
    """Put it among the artefacts, with its plan, and hold its content no longer."""
    artefacts.put(product.content)
    made = None if product.plan is None else keep(product.plan, artefacts)
    return replace(product, content=b"", plan=made)


def plan_of(question: Question, artefacts: Artefacts | None = None) -> Plan:
    """The plan that a rollout's question asks for, holds, or names among the artefacts.

    Raises:
        InputError: If it is none, or not stored any more.
    """
    from stairwright.planning.plan import Plan

    if question.get("ask"):
        plan = _plan(question["ask"])
    elif question.get("plan"):
        plan = Plan.model_validate(question["plan"])
    else:
        assert artefacts is not None
        plan = Plan.model_validate_json(stored_plan(question, artefacts))
    return plan


def stored_plan(question: Question, artefacts: Artefacts) -> bytes:
    """The JSON of the plan that a rollout's question names.

    Raises:
        InputError: If it is not stored any more.
    """
    try:
        return artefacts.content(question["plan_digest"])
    except FileNotFoundError:
        raise InputError("the plan is not stored any more", ("plan_id",)) from None


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
