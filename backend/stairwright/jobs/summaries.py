"""What a list tells of a result without opening it: what was asked, and the figures."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stairwright.planning.plan import Plan, Pose
    from stairwright.simulation.margins_result import RobustMargins
    from stairwright.simulation.result import Rollout
    from stairwright.simulation.trials_result import Trials

OUTLINE = 32  # points of a terrain that a thumbnail shows
_MARGINS = ("clearance", "com", "friction", "torque")


def of_plan(plan: Plan) -> dict[str, Any]:
    """Question, verdict, least margins [m, m, 1, Nm], duration [s], energy [J], a thumbnail."""
    from stairwright.planning.weights import MODELS

    usual = MODELS[plan.method]().model_dump()
    changed = {name: value for name, value in plan.weights.items() if value != usual.get(name)}
    return {
        **_question(plan),
        "status": plan.status,
        "problem": None if plan.problem is None else plan.problem.message,
        "friction": plan.friction,
        "weights": changed,
        "timing": "fast" if plan.timing.rule == "fast" else "steady",
        "facing": plan.facing,
        "tolerance": plan.tolerance.asked if plan.tolerance else {},
        "margins": _least(plan.poses),
        "duration": plan.timing.total if plan.feasible else None,
        "planned_energy": plan.energy,
        "planned_cost_of_transport": plan.cost_of_transport,
        **_thumbnail(plan),
    }


def of_rollout(run: Rollout, plan: Plan) -> dict[str, Any]:
    """The same of a rollout and the plan that it carried out, with outcome and metrics."""
    return {
        **of_plan(plan),
        "plan_id": plan.id,
        "outcome": run.outcome,
        "reason": run.reason,
        "friction": run.friction,
        "controller": run.controller.model_dump(mode="json", exclude_defaults=True),
        "seed": run.seed,
        "disturbance": {name: value for name, value in run.disturbance.items() if value},
        "metrics": run.metrics.model_dump(mode="json"),
        "duration": run.metrics.duration,
        "cost_of_transport": run.metrics.cost_of_transport,
        **({} if run.success else _end(run)),
    }


def of_trials(found: Trials, plan: Plan) -> dict[str, Any]:
    """The same of a set of trials, with successes and their 95 % interval."""
    from stairwright.simulation.ranges import BUNDLES

    named = (name for name, ranges in BUNDLES.items() if ranges == found.ranges)
    return {
        **of_plan(plan),
        "plan_id": plan.id,
        "friction": found.friction,
        "controller": found.controller.model_dump(mode="json", exclude_defaults=True),
        "seed": found.seed,
        "bundle": next(named, None),
        "count": found.count,
        "successes": found.successes,
        "interval": found.clopper_pearson,
        "outcomes": found.outcomes,
    }


def of_margins(found: RobustMargins, plan: Plan) -> dict[str, Any]:
    """The same of a plan's delay [s] and friction margin."""
    return {
        **of_plan(plan),
        "plan_id": plan.id,
        "controller": found.controller.model_dump(mode="json", exclude_defaults=True),
        "seed": found.seed,
        "delay_margin": found.delay,
        "friction_margin": found.friction,
    }


def _question(plan: Plan) -> dict[str, Any]:
    return {"terrain": plan.terrain.name, "robot": plan.robot, "method": plan.method}


def _least(poses: Sequence[Pose]) -> Mapping[str, float] | None:
    if not poses:
        return None
    return {name: min(getattr(pose.margins, name) for pose in poses) for name in _MARGINS}


def _thumbnail(plan: Plan) -> dict[str, Any]:
    """Outline of the terrain, and the pose where the least margin or the obstruction is."""
    points = plan.terrain.points
    step = max(1, -(-len(points) // OUTLINE))
    outline = [*points[:-1:step], points[-1]]
    place = plan.problem or plan.binding
    pose = None
    if plan.poses:
        at = plan.poses[-1].progress if place is None else place.progress
        worst = min(plan.poses, key=lambda each: abs(each.progress - at))
        pose = _drawn(worst.x_c, worst.z_c, worst.pitch, worst.q)
    return {"outline": [[round(x, 3), round(z, 3)] for x, z in outline], "pose": pose}


def _end(run: Rollout) -> dict[str, Any]:
    """Where a robot that did not arrive ended; nothing where it left finite numbers at once."""
    series = run.series
    if len(series) == 0:
        return {}
    x, _, z = series.base_position[-1]
    left_and_right = series.q[-1].reshape(2, 2, 3)  # of front and rear: thigh, calf, wheel
    q = left_and_right[:, :, :2].mean(axis=1).ravel()
    return {"pose": _drawn(x, z, series.pitch[-1], q)}


def _drawn(x: float, z: float, pitch: float, q: Iterable[float]) -> dict[str, Any]:
    """A pose as thumbnails take it: trunk [m, rad], planar joints [rad]."""
    return {
        "x": round(float(x), 3),
        "z": round(float(z), 3),
        "pitch": round(float(pitch), 3),
        "q": [round(float(angle), 3) for angle in q],
    }
