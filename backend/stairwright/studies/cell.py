"""One cell: plan, judge, simulate if asked. A pure function of the question."""

from __future__ import annotations

from collections import Counter

from stairwright.errors import InputError
from stairwright.planning.courses import kept_in
from stairwright.planning.plan import Plan
from stairwright.planning.planner import plan as make_plan
from stairwright.planning.smoothing.path_document import distance_covered, least_margins
from stairwright.planning.threads import one_by_one
from stairwright.simulation.intervals import clopper_pearson

from .axes import Value
from .document import Study
from .question import CellQuestion, Questions
from .variables import DONE, FAILED, REFUSED, Record, complete


def evaluate(questions: Questions, point: tuple[Value, ...]) -> Record:
    """What is to be known of the cell at `point`; never raises for what a cell can be.

    A combination of values that makes no question is an answer, and so is a bug: it is recorded
    with its reason, so that it is not tried for ever.
    """
    try:
        question = questions.at(point)
    except InputError as error:
        return complete({"state": REFUSED, "reason": "bad-input", "message": str(error)})
    try:
        with one_by_one(), kept_in(questions.courses):
            return complete(_answer(questions.study, question, _diagnosed(questions.study, point)))
    except Exception as error:  # noqa: BLE001 - one cell must not end the others
        why = f"{type(error).__name__}: {error}"
        return complete({"state": FAILED, "reason": "bug", "message": " ".join(why.split())})


def _diagnosed(study: Study, point: tuple[Value, ...]) -> bool:
    """Whether a cell without a way is asked what would open it."""
    axis = study.boundary_axis
    if study.diagnose != "last" or axis is None:
        return study.diagnose == "all"
    return point[study.axes.index(axis)] == axis.points[-1]


def _answer(study: Study, question: CellQuestion, diagnose: bool) -> Record:
    plan = make_plan(
        question.terrain,
        question.robot,
        question.friction,
        question.method,
        dict(question.weights),
        timing=question.timing,
        facing=question.facing,
        tolerance=question.tolerance,
        diagnose=diagnose,
    )
    record: Record = {"state": DONE, **_of_plan(plan)}
    if not diagnose:
        record.pop("reason", None)  # the message says where it ends
    if study.compute != "plan" and plan.executable and plan.feasible:
        record |= (_rolled_out if study.compute == "rollout" else _tried)(study, question, plan)
    elif study.compute != "plan":
        record["outcome"] = "no plan"
    return record


def _of_plan(plan: Plan) -> Record:
    record: Record = {
        "feasible": plan.feasible,
        "plan_id": plan.id,
        "duration": plan.timing.total if plan.feasible else None,
    }
    problem = plan.problem
    if problem is not None:
        record |= {"reason": problem.kind, "message": problem.message}
        if problem.limit is not None:
            limit = problem.limit
            record |= {
                "quantity": limit.quantity,
                "needed": limit.needed,
                "available": limit.available,
            }
            if limit.quantity == "friction":
                record["least_friction"] = limit.needed
    if plan.feasible:
        record |= _margins(plan)
        record["speed"] = distance_covered(plan) / plan.timing.total
    return record


def _margins(plan: Plan) -> Record:
    """The least margin of each kind over all poses, and the one that is least for its size."""
    least = least_margins(plan)
    return {
        **{f"margin_{name}": value for name, value in least.items()},
        "least_friction": plan.friction - least["friction"],
        "binding": plan.binding.quantity if plan.binding is not None else None,
    }


def _rolled_out(study: Study, question: CellQuestion, plan: Plan) -> Record:
    from stairwright.simulation.rollout import rollout

    _ = study
    run = rollout(
        plan,
        controller=dict(question.controller) or None,
        seed=question.seed,
        disturbance=dict(question.disturbance) or None,
        record_hz=5.0,
        keep_plan=False,
    )
    low, high = clopper_pearson(int(run.success), 1)
    return {
        "outcome": run.outcome,
        "duration": run.metrics.duration,
        "speed": run.metrics.speed_mean,
        "energy": run.metrics.energy,
        "cost_of_transport": run.metrics.cost_of_transport,
        "success": int(run.success),
        "trials": 1,
        "success_low": low,
        "success_high": high,
    }


def _tried(study: Study, question: CellQuestion, plan: Plan) -> Record:
    from stairwright.simulation.trials import trials

    made = trials(
        plan,
        n=study.trials.count,
        seed=question.seed,
        ranges=study.trials.ranges,
        workers=1,
        controller=dict(question.controller) or None,
    )
    failures = Counter(made.outcomes)
    failures.pop("success", None)
    low, high = made.clopper_pearson
    return {
        "outcome": failures.most_common(1)[0][0] if failures else "success",
        "success": made.successes,
        "trials": made.count,
        "success_low": low,
        "success_high": high,
    }
