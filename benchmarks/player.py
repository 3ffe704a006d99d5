"""The player that a bundle brings, built and run as a process, drives simulated robots.

    python benchmarks/player.py [--robot go2w] [--terrains NAME ...] [--model FILE] [--seeds 3]
        [--player FILE]

For each terrain a plan's bundle is written, its player is driven by sensors with noise over a
socket, and the ending is judged as a rollout's. With `--model`, the maker's own MJCF or URDF is
simulated too; its abduction motors are then held by the player. The table holds the endings, and
how long a step of estimation and control took (wall-clock).
"""

from __future__ import annotations

import argparse
import re
import socket
import statistics
import subprocess
import tempfile
import zipfile
from pathlib import Path

from report import Row, publish

import stairwright as sw
from stairwright.planning.plan import Plan
from stairwright.simulation.low_level import LowLevelRobot, Played, play

TERRAINS = ("single-stair-030", "single-stair-036", "three-stairs-up-down")


def unpack(plan: Plan, folder: Path) -> Path:
    """The bundle's top folder."""
    plan.save(str(folder / "bundle.zip"))
    with zipfile.ZipFile(folder / "bundle.zip") as archive:
        archive.extractall(folder)
        return folder / archive.namelist()[0].split("/")[0]


def build(top: Path) -> Path:
    """The player, compiled as the bundle's README says."""
    options = ("-DSTAIRWRIGHT_PYTHON=OFF", "-DSTAIRWRIGHT_PLAYER=ON")
    made = top / "build"
    subprocess.run(("cmake", "-S", top / "native", "-B", made, *options), check=True)
    subprocess.run(("cmake", "--build", made, "-j2"), check=True)
    return made / "stairwright_player"


def carry_out(player: Path, plan_file: Path, robot: LowLevelRobot) -> tuple[Played, str]:
    """What became of it, and what the player said."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port = int(probe.getsockname()[1])
    command = [player, plan_file, "--port", str(port), "--timeout", "20", "--stand", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        played = play(robot, ("127.0.0.1", port))
        said, _ = process.communicate(timeout=60)
    return played, said


def rows_of(player: Path, plan: Plan, plan_file: Path, model: str | None, seeds: int) -> Row:
    """One terrain and one model, several seeds of the sensors' noise."""
    good, errors, steps, words = 0, [], [], []
    for seed in range(seeds):
        played, said = carry_out(player, plan_file, LowLevelRobot(plan, model=model, seed=seed))
        good += played.outcome == "success"
        errors.append(1e3 * played.end_error)
        if found := re.search(r"of (\d+) us on average", said):
            steps.append(int(found[1]))
        if played.outcome != "success":
            words.append(f"{played.reason} {said.splitlines()[-2]}")
    note = f"{statistics.median(steps)} us a step; {' '.join(words)}".rstrip("; ")
    name = Path(model).name if model else "our model"
    return Row(
        f"{plan.robot}, {plan.terrain.name}",
        name,
        statistics.median(errors),
        max(errors),
        "mm",
        None,
        f"{good} of {seeds}",
        note,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--robot", default="go2w")
    parser.add_argument("--terrains", nargs="*", default=TERRAINS)
    parser.add_argument("--friction", type=float, default=0.6)
    parser.add_argument("--model", help="the maker's own MJCF or URDF, simulated too")
    parser.add_argument("--player", type=Path, help="a player that is built already")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--json", help="write machine and rows to this file too")
    given = parser.parse_args()
    plans = [sw.plan(terrain, given.robot, given.friction) for terrain in given.terrains]
    models = [None, *([given.model] if given.model else [])]
    rows = []
    with tempfile.TemporaryDirectory() as place:
        tops = []
        for k, plan in enumerate(plans):
            (Path(place) / str(k)).mkdir()
            tops.append(unpack(plan, Path(place) / str(k)))
        player = given.player or build(tops[0])
        for plan, top in zip(plans, tops, strict=True):
            for model in models:
                rows.append(rows_of(player, plan, top / "plan.txt", model, given.seeds))
    publish(rows, given.json)


if __name__ == "__main__":
    main()
