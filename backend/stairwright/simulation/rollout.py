"""Carry out a plan in headless MuJoCo: 1 ms physics, 500 Hz control, an honest outcome."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import Any

from stairwright.arguments import MOST_SEED, as_friction, as_model, as_number, as_whole
from stairwright.control.settings import ControllerSettings, parse_settings
from stairwright.errors import InputError
from stairwright.planning.plan import Plan
from stairwright.robot.mujoco_model import TIMESTEP

from .disturbance import Disturbance, parse_disturbance
from .physics import CONTROL_STEPS, Physics
from .record import Recorder
from .result import Rollout
from .run import Run


def rollout(
    plan: Plan | Mapping[str, Any],
    friction: float | None = None,
    controller: Mapping[str, Any] | ControllerSettings | None = None,
    seed: int = 0,
    progress: Callable[[float], None] | None = None,
    disturbance: Mapping[str, Any] | Disturbance | None = None,
    record_hz: float = 100.0,
    keep_plan: bool = True,
    observe: Callable[[Recorder], None] | None = None,
    model: str | os.PathLike[str] | None = None,
) -> Rollout:
    """Simulate a plan.

    Args:
        plan: A plan with at least two poses, or its document. An infeasible one may be tried.
        friction: True Coulomb friction; the plan's by default. The controller knows the least with
            which the plan holds.
        controller: Settings by name, see `ControllerSettings`.
        seed: Of the sensor noise.
        progress: Called now and then with the share done, 0..1; may raise `Cancelled`.
        disturbance: Deviations from what the plan believes, see `Disturbance`.
        record_hz: Rate of the recorded series.
        keep_plan: Embed the plan in the result.
        observe: Called as often as `progress` with the record so far.
        model: The robot's own MJCF or URDF file (or its text), simulated in the place of our model
            of it; see `original` for what of it is kept and how joints are mapped. The loop is not
            the native one: about twice as fast as real time, with sensing ideal.

    Raises:
        InputError: If an argument is bad or the plan has no poses.
    """
    plan = as_model(Plan, plan, "plan")
    if not plan.executable:
        why = plan.problem.message if plan.problem else "the plan has no poses"
        raise InputError(f"nothing can be rolled out: {why}", ("plan",))
    settings, deviations = parse_settings(controller), parse_disturbance(disturbance)
    truth = plan.friction if friction is None else as_friction(friction)
    seed = as_whole(seed, 0, MOST_SEED, "seed")
    control_hz = 1.0 / (CONTROL_STEPS * TIMESTEP)
    record_hz = as_number(record_hz, "record_hz")
    if not 1.0 <= record_hz <= control_hz:
        raise InputError(f"must be from 1 to {control_hz:g}", ("record_hz",))
    physics: Physics | None = None
    if model is not None:
        from .original_physics import OriginalPhysics

        if isinstance(controller, Mapping) and controller.get("sensing") == "robot":
            raise InputError("is for our own model of the robot", ("controller", "sensing"))
        settings = settings.model_copy(update={"sensing": "ideal"})
        physics = OriginalPhysics(model, plan, truth, deviations, seed)
    run = Run(plan, truth, settings, deviations, seed, record_hz, physics)
    return run.result(run.simulate(progress, observe), keep_plan)
