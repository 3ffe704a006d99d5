"""`stairwright robot ...`: robots from other files, and in the newest schema."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import InputError

if TYPE_CHECKING:
    from .robot.description import Robot
    from .robot.importing.report import Imported


def robot_command(given: argparse.Namespace) -> str | None:
    """`stairwright robot import` and `convert`."""
    if given.output:
        from .export.table import ROBOT_FORMATS, by_ending

        by_ending(ROBOT_FORMATS, given.output, "robot")  # complaints come before the work
    return {"import": _import, "convert": _convert}[given.action](given)


def _import(given: argparse.Namespace) -> None:
    from .importing import import_robot
    from .robot.importing.holding import written_hold

    hold = written_hold(given.hold)
    made = import_robot(given.file, given.abduction, wheel_radius=given.wheel_radius, hold=hold)
    if given.output:
        made.robot.save(given.output)
    if given.json:
        print(made.model_dump_json(indent=1))
    else:
        print(_summary(made), file=sys.stdout if given.output else sys.stderr)
        _show(made.robot, given)


def _convert(given: argparse.Namespace) -> None:
    from .library import load_robot
    from .robot.conversion import to_latest

    if Path(given.file).suffix.lower() in (".urdf", ".xml", ".mjcf", ".zip"):
        raise InputError(f"{given.file} is none of our files: stairwright robot import reads it")
    robot = to_latest(load_robot(given.file))
    if given.output:
        robot.save(given.output)
    _show(robot, given)


def _show(robot: Robot, given: argparse.Namespace) -> None:
    if not given.output:
        from .export.yaml_file import robot_yaml

        sys.stdout.write(robot_yaml(robot).decode())


def _summary(made: Imported) -> str:
    robot = made.robot
    front, rear = robot.legs
    measures = (
        f"{robot.mass:.4g} kg, wheels {2e3 * robot.wheel.radius:.4g} mm across, "
        f"thigh {front.thigh.length:.4g} m, calf {front.calf.length:.4g} m, "
        f"hips {front.hip[0] - rear.hip[0]:.4g} m apart"
    )
    lines = [f"{robot.name}: {measures}"]
    lines += [f"assumed: {each}" for each in made.assumed]
    lines += [f"warning: {each}" for each in made.warnings]
    return "\n".join(lines)
