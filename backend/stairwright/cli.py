"""The command `stairwright`: arguments, and exit statuses. Heavy imports wait for `commands`."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

from . import __version__
from .api.addresses import MOST_PORT
from .errors import InputError, StairwrightError
from .export.table import FORMATS, USUAL_RATE, names

DONE, FAILED, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130
METHODS = ("path", "critical", "nominal")
TERRAIN = "a preset's name, a file, or measures, as stair:rise=0.18,run=0.28,count=5"


class Parser(argparse.ArgumentParser):
    """Says what is wrong in one line."""

    def error(self, message: str) -> NoReturn:
        """End with status 2."""
        self.exit(BAD_INPUT, f"{self.prog}: {message} (see {self.prog} --help)\n")

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """What is unknown is refused by the command it was given to, whose help says more."""
        chosen, unknown = super().parse_known_args(args, namespace)
        if unknown:
            self.error(f"unrecognized arguments: {' '.join(unknown)}")
        return chosen, unknown


def parser() -> argparse.ArgumentParser:
    """All commands and their arguments."""
    top = Parser(
        prog="stairwright",
        description="Can a wheel-legged robot roll over these stairs, and how?",
        epilog="Exit status: 0 done, 1 the terrain is infeasible or the rollout failed, 2 bad "
        "input. STAIRWRIGHT_DATA names the data folder, STAIRWRIGHT_TOKEN a bearer token.",
    )
    top.add_argument("--version", action="version", version=f"stairwright {__version__}")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")

    serve = commands.add_parser("serve", help="serve the page, REST and the 3D scene")
    serve.add_argument("--host", help="address to serve on (127.0.0.1)")
    serve.add_argument("--port", type=_port, help="port to serve on (8000)")

    plan = commands.add_parser("plan", help="plan the poses over a terrain")
    plan.add_argument("terrain", metavar="TERRAIN", help=TERRAIN)
    _add_planning(plan)
    plan.add_argument("-o", "--output", metavar="FILE", help=names("plan"))
    _add_rate(plan)

    rollout = commands.add_parser("rollout", help="carry a plan out in simulation")
    _add_carrying_out(rollout)
    rollout.add_argument(
        "--disturbance",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="how the real world differs from what is believed",
    )
    rollout.add_argument(
        "--world", metavar="NAME", help="what trials deviate by: usual, laboratory or field"
    )
    rollout.add_argument(
        "--trials", type=int, metavar="N", help="N times in slightly different worlds"
    )
    rollout.add_argument(
        "--workers", type=int, metavar="N", help="share trials among so many; default: all cores"
    )
    _add_model(rollout)
    rollout.add_argument("-o", "--output", metavar="FILE", help=names("rollout"))

    margins = commands.add_parser(
        "margins", help="how much delay and how much less friction a plan stands"
    )
    _add_carrying_out(margins)
    margins.add_argument("-o", "--output", metavar="FILE", help=".json")

    export = commands.add_parser("export", help="write a plan, rollout or robot in another format")
    export.add_argument(
        "file", metavar="FILE", help="a plan or rollout (json, npz), or a robot (yaml, its name)"
    )
    kinds = "; ".join(f"{kind}: {names(kind)}" for kind in FORMATS)
    export.add_argument("--format", metavar="F", help=f"{kinds}; the output's ending by default")
    _add_rate(export)
    export.add_argument("-o", "--output", metavar="FILE", required=True)

    rehearse = commands.add_parser("rehearse", help="be the robot that a bundle's player drives")
    rehearse.add_argument("plan", metavar="PLAN", help="the plan's file, as in the bundle")
    rehearse.add_argument("--host", default="127.0.0.1", help="of the player (%(default)s)")
    rehearse.add_argument("--port", type=_port, default=9100, help="of the player (%(default)s)")
    rehearse.add_argument("--friction", type=float, metavar="F", help="the plan's by default")
    _add_seed(rehearse)
    _add_model(rehearse)

    certify = commands.add_parser("certify", help="check a plan independently and exactly")
    certify.add_argument("plan", metavar="PLAN", help="a plan's file")

    bench = commands.add_parser("bench", help="measure solve times and outcomes on this machine")
    bench.add_argument("terrains", metavar="TERRAIN", nargs="*", help="all presets by default")
    bench.add_argument("--robot", action="append", metavar="R", help="all robots by default")
    bench.add_argument("--method", choices=METHODS, default="path")
    bench.add_argument("--repeat", type=int, default=5, metavar="N", help="solves each")

    study = commands.add_parser("study", help="ask over whole ranges of terrains and robots")
    study.add_argument("file", metavar="FILE", help="the study's document (yaml, json)")
    study.add_argument("-o", "--output", metavar="FILE", help=".zarr, .nc or .csv")
    _add_engine(study)
    study.add_argument("--retry", action="store_true", help="try failed cells again")

    design = commands.add_parser("design", help="look for a robot's best dimensions")
    design.add_argument("file", metavar="FILE", help="the design study's document (yaml, json)")
    design.add_argument("-o", "--output", metavar="FILE", help=".json")
    _add_engine(design)

    commands.add_parser("terrains", help="list the terrain presets")
    commands.add_parser("robots", help="list the robots")
    _add_robot(commands.add_parser("robot", help="read robots from other files, or convert them"))
    return top


def _add_robot(command: argparse.ArgumentParser) -> None:
    actions = command.add_subparsers(dest="action", required=True, metavar="ACTION")
    reading = actions.add_parser("import", help="read a URDF or MJCF file")
    reading.add_argument("file", metavar="FILE", help=".urdf, .xml, or a .zip with the meshes")
    reading.add_argument(
        "--abduction",
        type=float,
        default=0.0,
        metavar="RAD",
        help="lock the legs outward by so much",
    )
    reading.add_argument(
        "--wheel-radius", type=float, metavar="M", help="where the file does not show it"
    )
    reading.add_argument(
        "--hold",
        action="append",
        default=[],
        metavar="JOINT=RAD",
        help="a joint that is rigid there (an arm's, an ankle's); may be given again",
    )
    reading.add_argument("--json", action="store_true", help="print robot, assumed and warnings")
    convert = actions.add_parser("convert", help="write a robot in the newest schema")
    convert.add_argument("file", metavar="FILE", help="a robot (yaml, json, its name)")
    for action in (reading, convert):
        action.add_argument(
            "-o", "--output", metavar="FILE", help=f"{names('robot')}; else printed"
        )


def _add_planning(command: argparse.ArgumentParser) -> None:
    command.add_argument("--robot", metavar="R", help="a robot's name or file (a1_wheeled)")
    command.add_argument("--friction", type=float, metavar="F", help="the terrain's by default")
    command.add_argument("--method", choices=METHODS, help="(path)")
    command.add_argument("--timing", choices=("steady", "fast"), help="of a path (steady)")
    command.add_argument(
        "--facing",
        choices=("forward", "backward", "either"),
        help="which end of the robot leads (forward; either where timing is fast)",
    )
    command.add_argument(
        "--solver", choices=("native", "ipopt"), help="of the poses of critical (native)"
    )
    command.add_argument(
        "--weight", action="append", default=[], metavar="NAME=VALUE", help="of the planner"
    )
    command.add_argument(
        "--tolerance",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="that the certificate holds for: height, place (m), friction",
    )


def _add_carrying_out(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "source", metavar="PLAN-or-TERRAIN", help="a plan's file, or a terrain as for plan"
    )
    _add_planning(command)
    _add_seed(command)
    command.add_argument(
        "--controller", action="append", default=[], metavar="NAME=VALUE", help="a setting"
    )


def _add_seed(command: argparse.ArgumentParser) -> None:
    command.add_argument("--seed", type=int, default=0, help="of the sensor noise (%(default)s)")


def _add_model(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--model", metavar="FILE", help="simulate the robot's own MJCF or URDF, not our model of it"
    )


def _port(text: str) -> int:
    if not text.isdecimal() or int(text) > MOST_PORT:
        raise argparse.ArgumentTypeError(f"must be a number from 0 to {MOST_PORT}, not {text!r}")
    return int(text)


def _add_engine(command: argparse.ArgumentParser) -> None:
    command.add_argument("--workers", type=int, metavar="N", help="processes; default: all cores")
    command.add_argument("--scheduler", metavar="ADDRESS", help="of Dask (STAIRWRIGHT_SCHEDULER)")
    command.add_argument("--budget", type=int, metavar="N", help="cells or trials it may take")


def _add_rate(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--rate", type=float, metavar="HZ", help=f"of the joint commands in mcap ({USUAL_RATE:g})"
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; returns the exit status."""
    chosen = parser().parse_args(arguments)
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # others would only spin: matrices are small
    try:
        if chosen.command == "serve":
            from .api.server import serve

            return serve(host=chosen.host, port=chosen.port)
        from . import commands

        reason = commands.COMMANDS[chosen.command](chosen)
        sys.stdout.flush()
    except InputError as error:
        return _end(BAD_INPUT, str(error))
    except StairwrightError as error:  # a cluster of another version, one that went away
        return _end(FAILED, str(error))
    except BrokenPipeError:
        # Whoever read our output has gone; a second error at exit would be noise.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except KeyboardInterrupt:
        return _end(INTERRUPTED, "interrupted")
    return DONE if reason is None else _end(FAILED, reason)


def _end(status: int, reason: str) -> int:
    print("stairwright:", " ".join(reason.split()), file=sys.stderr)
    return status


if __name__ == "__main__":
    sys.exit(main())
