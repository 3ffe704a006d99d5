"""`stairwright robot import` and `convert`, and rollouts of a robot's own file."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import stairwright as sw
from stairwright.robot.conversion import to_latest
from tests.cli.test_cli import run
from tests.robot.importing.files import LEGS, Design
from tests.robot.importing.written import mjcf, urdf


@pytest.fixture(scope="module")
def maker(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("maker") / "maker.urdf"
    path.write_text(urdf(Design()))
    return path


@pytest.mark.slow
def test_a_file_is_imported(maker: Path, tmp_path: Path) -> None:
    out = tmp_path / "robot.yaml"
    said = run("robot", "import", maker, "-o", out)
    assert "17.8 kg" in said
    assert "assumed: " in said
    assert "warning: " in said
    robot = sw.load_robot(out)
    report = json.loads(run("robot", "import", maker, "--json"))
    assert {"robot", "assumed", "warnings"} <= report.keys()
    assert sw.load_robot(report["robot"]) == robot
    assert robot == sw.import_robot(maker).robot


@pytest.mark.slow
def test_without_an_output_the_robot_is_printed_as_options_have_it(
    maker: Path, tmp_path: Path
) -> None:
    printed = tmp_path / "printed.yaml"
    arguments = ("--abduction", "-0.05", "--wheel-radius", "0.09")
    printed.write_text(run("robot", "import", maker, *arguments))
    robot = sw.load_robot(printed)
    assert robot.abduction == -0.05
    assert robot.wheel.radius == 0.09


@pytest.mark.slow
def test_joints_are_held_as_options_have_it(maker: Path, tmp_path: Path) -> None:
    out = tmp_path / "held.yaml"
    options = [text for leg in LEGS for text in ("--hold", f"{leg}_hip_joint=0.02")]
    run("robot", "import", maker, *options, "-o", out)
    assert sw.load_robot(out).held_joints == {f"{leg}_hip_joint": 0.02 for leg in LEGS}


@pytest.mark.parametrize(
    "arguments",
    [
        ("import", "nowhere.urdf"),
        ("import", "MAKER", "--abduction", "1"),
        ("import", "MAKER", "--wheel-radius", "0"),
        ("import", "MAKER", "--hold", "FL_hip_joint"),
        ("import", "MAKER", "--hold", "nobody=0"),
        ("import", "MAKER", "-o", "robot.step"),
        ("convert", "MAKER"),
        ("convert", "nobody"),
        ("melt", "MAKER"),
        (),
    ],
)
def test_bad_input(arguments: tuple[str, ...], maker: Path) -> None:
    run("robot", *(maker if each == "MAKER" else each for each in arguments), status=2)


def test_a_file_that_does_not_fit(maker: Path, tmp_path: Path) -> None:
    biped = tmp_path / "biped.urdf"
    text = maker.read_text()
    biped.write_text(
        text.replace(
            '<joint name="RL_wheel_joint" type="continuous"',
            '<joint name="RL_wheel_joint" type="fixed"',
        )
    )
    run("robot", "import", biped, status=2)


@pytest.mark.parametrize("suffix", ["yaml", "json"])
def test_robots_are_converted_to_the_newest_schema(suffix: str, tmp_path: Path) -> None:
    old, out = sw.load_robot("a1_wheeled"), tmp_path / f"new.{suffix}"
    run("robot", "convert", "a1_wheeled", "-o", out)
    new = sw.load_robot(out)
    assert new.schema_ == "stairwright/robot/2"
    assert new == to_latest(old)
    same = {"exclude": {"schema_"}}
    assert new.model_dump(**same) == old.model_dump(**same)
    assert run("robot", "convert", out) == run("robot", "convert", "a1_wheeled")


@pytest.mark.slow
def test_what_was_imported_is_planned_with(maker: Path, tmp_path: Path) -> None:
    out, curb = tmp_path / "robot.yaml", tmp_path / "curb.json"
    sw.import_robot(maker).robot.save(str(out))
    curb.write_text('{"points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}')
    assert "feasible" in run("plan", curb, "--robot", out)
    run("export", out, "-o", tmp_path / "robot.xml")


@pytest.mark.slow
def test_the_original_is_rolled_out(tmp_path: Path) -> None:
    model, robot = tmp_path / "maker.xml", tmp_path / "robot.yaml"
    model.write_text(mjcf(Design()))
    curb = tmp_path / "curb.json"
    curb.write_text('{"points": [[-0.5, 0], [0, 0], [0, 0.05], [0.5, 0.05]]}')
    run("robot", "import", model, "-o", robot)
    assert "maker.xml" in run("rollout", curb, "--robot", robot, "--model", model)
    run("rollout", curb, "--robot", "a1_wheeled", "--model", model, status=2)
