"""Plans, rollouts and certificates in a few readable lines; angles in degrees."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .benchmark import Figures
    from .planning.plan import Certificate, Plan
    from .simulation.margins_result import RobustMargins
    from .simulation.result import Metrics, Rollout
    from .simulation.trials_result import Trials


def columns(rows: Iterable[tuple[str, str]]) -> str:
    """Two columns."""
    table = list(rows)
    width = max((len(name) for name, _ in table), default=0)
    return "\n".join(f"{name:<{width}}  {text}".rstrip() for name, text in table)


def of_plan(plan: Plan) -> str:
    """What was asked, whether it can be done, how close it is."""
    verdict: str = plan.status
    if plan.poses:
        verdict += (
            f": {len(plan.poses)} poses over {plan.poses[-1].progress:.2f} m"
            f" in {plan.timing.total:.1f} s"
        )
    rows = [
        ("terrain", f"{plan.terrain.name}, friction {plan.friction:g}"),
        ("robot", plan.robot + (", facing backward" if plan.facing == "backward" else "")),
        (f"{plan.method} plan", f"{verdict}; solved in {plan.solve_time * 1e3:.0f} ms"),
    ]
    if plan.problem is not None:
        x, z = plan.problem.at
        rows.append(("problem", f"{plan.problem.kind} at x = {x:.3f} m, z = {z:.3f} m"))
        if plan.problem.limit is not None:
            limit = plan.problem.limit
            unit = f" {limit.unit}" if limit.unit else ""
            rows.append(
                ("", f"needed {limit.needed:.4g}{unit}, available {limit.available:.4g}{unit}")
            )
    if plan.poses:
        rows.append(("least margins", _margins(plan)))
    if plan.safer_facing is not None:
        safer = plan.safer_facing
        name, least = ("CoM", safer.com_margin)
        if safer.by == "clearance" and safer.clearance is not None:
            name, least = ("clearance", safer.clearance)
        rows.append(("safer", f"facing {safer.facing}: {name} {least * 1e3:.0f} mm"))
    if plan.certificate is not None:
        passed = "passed" if plan.certificate.passed else "NOT passed"
        rows.append(("certificate", f"{passed} ({plan.certificate.scope})"))
        if plan.certificate.motion is not None:
            rows.append(("", plan.certificate.motion.message))
    if plan.tolerance is not None:
        asked = ", ".join(f"{name} {value:g}" for name, value in plan.tolerance.asked.items())
        rows.append(("tolerance", asked))
    rows.append(("id", plan.id))
    return columns(rows)


def _margins(plan: Plan) -> str:
    least = {
        name: min(getattr(pose.margins, name) for pose in plan.poses)
        for name in ("clearance", "com", "friction", "torque")
    }
    return (
        f"clearance {least['clearance'] * 1e3:.0f} mm, CoM {least['com'] * 1e3:.0f} mm, "
        f"friction {least['friction']:.2f}, torque {least['torque']:.1f} Nm"
    )


def of_trials(made: Trials) -> str:
    """How many succeeded, how sure that is, and what became of the others."""
    low, high = made.clopper_pearson
    suspects = ", ".join(f"{name} {share:.0%}" for name, share in made.suspects.items())
    outcomes = ", ".join(f"{count} {name}" for name, count in sorted(made.outcomes.items()))
    return columns(
        [
            ("trials", f"{made.successes} of {made.count} succeeded ({made.rate:.1%})"),
            ("95 % interval", f"{low:.1%} to {high:.1%} (Clopper-Pearson)"),
            ("outcomes", outcomes),
            *([("suspects", suspects)] if suspects else []),
            ("worst pitch", _degrees(max(trial.pitch_error_max for trial in made.trials))),
        ]
    )


def of_margins(found: RobustMargins) -> str:
    """Up to where every rollout succeeds, and what happens beyond."""
    if found.delay is None or found.friction is None:
        return columns([("margins", f"none: even undisturbed it fails: {found.delay_ends}")])
    beyond = found.delay_ends or "nothing was tried beyond"
    slippery = found.friction_ends or "nothing was tried beyond"
    return columns(
        [
            ("delay", f"stands {found.delay * 1e3:.0f} ms; {beyond}"),
            ("friction", f"stands {found.friction:.2f} less; {slippery}"),
            ("id", found.id),
        ]
    )


def of_rollout(run: Rollout) -> str:
    """What happened, and how well."""
    m = run.metrics
    return columns(
        [
            ("terrain", f"{run.terrain.name}, friction {run.friction:g}"),
            ("robot", run.robot),
            *([("simulated", run.model.partition(":")[0])] if run.model else []),
            ("outcome", f"{run.outcome}. {run.reason}"),
            (
                "pitch error",
                _degrees(m.pitch_error_rms) + " rms, " + _degrees(m.pitch_error_max) + " at most",
            ),
            ("torque peaks", f"legs {m.torque_peak:.1f} Nm, wheels {m.wheel_torque_peak:.1f} Nm"),
            *([("torque rms", _warmth(m))] if m.torque_rms is not None else []),
            ("energy", f"{m.energy:.0f} J"),
            ("contacts", f"{m.link_contacts} control steps with a link on the terrain"),
            ("speed", f"{m.speed_mean:.3f} m/s; simulated {m.real_time_factor:.0f} x real time"),
            ("id", run.id),
        ]
    )


def _warmth(m: Metrics) -> str:
    """What heats the motors, and whether they stand it."""
    share = m.continuous_share
    known = "" if share is None else f", {100 * share:.0f} % of what a motor holds without end"
    return f"legs {m.torque_rms:.1f} Nm{known}"


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.2f} deg"


def of_certificate(certificate: Certificate) -> str:
    """A line for each check."""
    rows = [
        (
            check.name,
            f"{'passed' if check.passed else 'FAILED':<7} {check.value:10.4g} {check.unit}"
            f" (bound {check.bound:.4g})"
            + ("" if check.progress is None else f" at {check.progress:.3f} m"),
        )
        for check in certificate.checks
    ]
    rows.append(("certificate", "passed" if certificate.passed else "NOT passed"))
    return columns(rows)


_BENCH = "{:<28} {:<14} {:<10} {:>9} {:>9} {:>9}  {:<10} {:>7}"


def bench_head() -> str:
    """Names of the columns."""
    return _BENCH.format(
        "terrain", "robot", "plan", "median ms", "q1 ms", "q3 ms", "rollout", "x real"
    )


def bench_line(figures: Figures) -> str:
    """One terrain and robot."""
    q1, median, q3 = (value * 1e3 for value in figures.quartiles)
    factor = "" if figures.real_time_factor is None else f"{figures.real_time_factor:.0f}"
    cells = (f"{median:.1f}", f"{q1:.1f}", f"{q3:.1f}", figures.outcome or "-", factor)
    return _BENCH.format(figures.terrain, figures.robot, figures.status, *cells).rstrip()
