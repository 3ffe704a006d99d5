"""How much delay a plan stands, and how much less friction than planned: found by rollouts.

The largest delay, and the largest loss of friction, up to which every rollout on a grid succeeds: a
grid and not a bisection, because what succeeds is not always one interval.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from stairwright.arguments import as_model, as_whole
from stairwright.control.settings import ControllerSettings, parse_settings
from stairwright.documents import content_hash
from stairwright.planning.plan import Plan

from .disturbance import Disturbance
from .margins_result import RobustMargins
from .rollout import rollout

DELAYS = tuple(0.002 * k for k in range(1, 16))  # s, as fine as control steps are
FRICTIONS = tuple(0.05 * k for k in range(1, 10))  # lost
RECORD_HZ = 5.0


def robust_margins(
    plan: Plan | Mapping[str, Any],
    controller: Mapping[str, Any] | ControllerSettings | None = None,
    seed: int = 0,
    progress: Callable[[float], None] | None = None,
) -> RobustMargins:
    """Margins of `plan`: loop delay up to 30 ms, friction lost down to a tenth.

    Args:
        plan: What to carry out.
        controller: Settings by name, see `ControllerSettings`.
        seed: Of the sensor noise.
        progress: Called with the share done, 0..1; may raise `Cancelled`.

    Raises:
        InputError: If an argument is bad or the plan has no poses.
    """
    plan, settings = as_model(Plan, plan, "plan"), parse_settings(controller)
    seed = as_whole(seed, 0, 2**31 - 1, "seed")
    least = [lost for lost in FRICTIONS if plan.friction - lost >= 0.1 - 1e-9]
    steps, done = len(DELAYS) + len(least) + 1, 0

    def reason(disturbance: Disturbance) -> str:
        """Why a rollout does not succeed; empty if it does."""
        nonlocal done
        run = rollout(
            plan, controller=settings, seed=seed, disturbance=disturbance,
            record_hz=RECORD_HZ, keep_plan=False,
        )  # fmt: skip
        done += 1
        if progress is not None:
            progress(min(1.0, done / steps))
        return "" if run.success else run.reason

    asked = [plan.id, settings.model_dump(), seed]
    found = partial(
        RobustMargins,
        id="m-" + content_hash(asked).removeprefix("sha256:"),
        plan_id=plan.id,
        terrain_hash=plan.terrain_hash,
        robot_hash=plan.robot_hash,
        controller=settings,
        seed=seed,
    )
    ends = reason(Disturbance())
    if ends:
        return found(delay=None, friction=None, delay_ends=ends, friction_ends=ends)
    delay, delay_ends = _reach(DELAYS, lambda value: reason(Disturbance(delay=value)))
    friction, friction_ends = _reach(least, lambda value: reason(Disturbance(friction=-value)))
    if progress is not None:
        progress(1.0)
    return found(delay=delay, friction=friction, delay_ends=delay_ends, friction_ends=friction_ends)


def _reach(
    values: tuple[float, ...] | list[float], reason: Callable[[float], str]
) -> tuple[float, str]:
    """The last of the rising `values` up to which there is no reason, and the first reason."""
    reached = 0.0
    for value in values:
        why = reason(value)
        if why:
            return reached, why
        reached = round(value, 6)
    return reached, ""
