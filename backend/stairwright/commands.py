"""What the commands of the command line do. Each returns None, or why it could not be done."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from . import summary
from .command_arguments import Arguments, plan_or_file, planned, settings_of, terrain_of
from .errors import InputError
from .library import load_robot, load_terrain, robots, terrains
from .robot_commands import robot_command

if TYPE_CHECKING:
    from .planning.plan import Plan

Command = Callable[[Arguments], str | None]


def plan_command(given: Arguments) -> str | None:
    """`stairwright plan`."""
    if given.output:
        from .export.table import PLAN_FORMATS, by_ending

        # Complaints come before the work, not after it.
        by_ending(PLAN_FORMATS, given.output, "plan").check_rate(given.rate)
    elif given.rate is not None:
        raise InputError("is for a plan that is written to a file", ("rate",))
    plan = planned(given.terrain, given)
    if given.output:
        plan.save(given.output, given.rate)
    else:
        print(summary.of_plan(plan))
    return _obstacle(plan)


def rollout_command(given: Arguments) -> str | None:
    """`stairwright rollout`."""
    if given.seed < 0:
        raise InputError("must be a whole number from 0", ("seed",))
    if given.trials is not None:
        if given.model:
            raise InputError("trials simulate our own model", ("model",))
        return _trials(given)
    if given.output:
        from .export.table import ROLLOUT_FORMATS, by_ending

        by_ending(ROLLOUT_FORMATS, given.output, "rollout")
    plan = plan_or_file(given)
    if not plan.executable:
        return _obstacle(plan) or "the plan has no poses to carry out"
    from .simulation.rollout import rollout

    if given.world is not None:
        raise InputError("is for trials; use --disturbance for one rollout", ("world",))
    run = rollout(
        plan,
        friction=given.friction,
        controller=settings_of(given.controller, "controller"),
        seed=given.seed,
        model=given.model,
        disturbance=settings_of(given.disturbance, "disturbance"),
    )
    if given.output:
        run.save(given.output)
    else:
        print(summary.of_rollout(run))
    if not run.success:
        return f"{run.outcome}: {run.reason}"
    return _obstacle(plan)  # a plan that ends at the obstacle can be carried out as far as that


def _trials(given: Arguments) -> str | None:
    """`stairwright rollout --trials N`: the same plan in slightly different worlds."""
    if given.output and Path(given.output).suffix.lower() != ".json":
        raise InputError("trials can be written as .json only", ("output",))
    plan = plan_or_file(given)
    if not plan.executable:
        return _obstacle(plan) or "the plan has no poses to carry out"
    if given.disturbance:
        raise InputError("is for one rollout; use --world for trials", ("disturbance",))
    from .simulation.trials import trials

    made = trials(
        plan,
        n=given.trials,
        seed=given.seed,
        bundle=given.world,
        workers=given.workers,
        friction=given.friction,
        controller=settings_of(given.controller, "controller"),
    )
    if given.output:
        _write(given.output, made.model_dump_json(indent=1))
    else:
        print(summary.of_trials(made))
    failed = [trial for trial in made.trials if trial.outcome != "success"]
    if not failed:
        return None
    first = f"{failed[0].outcome}: {failed[0].reason}"
    return f"{len(failed)} of {made.count} trials failed; the first with {first}"


def margins_command(given: Arguments) -> str | None:
    """`stairwright margins`."""
    if given.output and Path(given.output).suffix.lower() != ".json":
        raise InputError("margins can be written as .json only", ("output",))
    plan = plan_or_file(given)
    if not plan.executable:
        return _obstacle(plan) or "the plan has no poses to carry out"
    from .simulation.robust_margins import robust_margins

    found = robust_margins(plan, settings_of(given.controller, "controller"), given.seed)
    if given.output:
        _write(given.output, found.model_dump_json(by_alias=True, indent=1))
    else:
        print(summary.of_margins(found))
    return None if found.delay is not None else found.delay_ends


def export_command(given: Arguments) -> str | None:
    """`stairwright export`."""
    from .export.formats import convert

    convert(given.file, given.format, given.output, given.rate)
    return None


def rehearse_command(given: Arguments) -> str | None:
    """`stairwright rehearse`."""
    from .export.formats import load_plan
    from .simulation.low_level import LowLevelRobot, play

    robot = LowLevelRobot(load_plan(given.plan), given.friction, given.model, given.seed)
    played = play(robot, (given.host, given.port))
    print(f"{played.outcome}: {played.reason}")
    return None if played.outcome == "success" else played.reason


def certify_command(given: Arguments) -> str | None:
    """`stairwright certify`."""
    from .export.formats import load_plan
    from .planning.certificate.certify import certify

    plan = load_plan(given.plan)
    certificate = certify(plan)
    print(summary.of_certificate(certificate))
    obstacle = _obstacle(plan)  # the poses before it may well pass
    if obstacle:
        return f"the plan is infeasible: {obstacle}"
    failed = [check.name for check in certificate.checks if not check.passed]
    if failed:
        return f"not passed: {', '.join(failed)}"
    return None if certificate.passed else "not passed"


def bench_command(given: Arguments) -> str | None:
    """`stairwright bench`."""
    from .benchmark import measure

    if given.repeat < 1:
        raise InputError("must be at least 1", ("repeat",))
    grounds = [terrain_of(name) for name in given.terrains or terrains()]
    machines = [load_robot(name) for name in given.robot or robots()]
    print(summary.bench_head())
    for terrain in grounds:
        for robot in machines:
            figures = measure(terrain, robot, given.method, given.repeat)
            print(summary.bench_line(figures), flush=True)
    return None


def study_command(given: Arguments) -> str | None:
    """`stairwright study`."""
    from .studies.command import run_study

    return run_study(given)


def design_command(given: Arguments) -> str | None:
    """`stairwright design`."""
    from .studies.command import run_design

    return run_design(given)


def terrains_command(_: Arguments) -> str | None:
    """`stairwright terrains`."""
    print(summary.columns((name, load_terrain(name).description) for name in terrains()))
    return None


def robots_command(_: Arguments) -> str | None:
    """`stairwright robots`."""
    print(summary.columns((name, load_robot(name).description) for name in robots()))
    return None


COMMANDS: Mapping[str, Command] = {
    "plan": plan_command,
    "rollout": rollout_command,
    "margins": margins_command,
    "export": export_command,
    "rehearse": rehearse_command,
    "certify": certify_command,
    "bench": bench_command,
    "study": study_command,
    "design": design_command,
    "terrains": terrains_command,
    "robots": robots_command,
    "robot": robot_command,
}


def _write(path: str, text: str) -> None:
    try:
        Path(path).write_text(text)
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror}") from None


def _obstacle(plan: Plan) -> str | None:
    if plan.feasible:
        return None
    return plan.problem.message if plan.problem else "the terrain is infeasible"
