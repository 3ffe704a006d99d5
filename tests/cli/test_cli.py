"""The command line: its output, its one line of complaint, its exit status."""

from __future__ import annotations

import contextlib
import io
import json
import socket
import subprocess
import sys
from pathlib import Path

import pytest

import stairwright as sw
from stairwright import commands
from stairwright.cli import main
from stairwright.documents import load_mapping
from stairwright.export.table import FORMATS
from stairwright.jobs.failures import WorkerDied
from stairwright.library import robots, terrains
from stairwright.resources import data_folder

CURB = '{"points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}'
WALL = '{"points": [[-1.0, 0], [0, 0], [0, 1.3], [1, 1.3]]}'


def run(*arguments: str | Path, status: int = 0) -> str:
    """Standard output of one command; on failure, its one line on standard error."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            returned = main([str(each) for each in arguments])
        except SystemExit as exit_:
            returned = int(exit_.code or 0)
    assert returned == status, err.getvalue()
    if status:
        assert err.getvalue().startswith("stairwright")
        assert err.getvalue().count("\n") == 1, err.getvalue()
    return out.getvalue()


@pytest.fixture(scope="module")
def curb(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("terrain") / "curb.json"
    path.write_text(CURB)
    return path


@pytest.fixture(scope="module")
def plan(curb: Path) -> Path:
    path = curb.with_name("plan.json")
    assert run("plan", curb, "--robot", "a1_wheeled_x", "-o", path) == ""
    return path


def test_a_terrain_by_its_measures() -> None:
    said = run("plan", "stair:rise=0.05,run=0.4,count=2,direction=down")
    assert "stair-0.05-0.4-x2-down" in said
    assert "success" in run("rollout", "flat:length=2")
    run("plan", "stair:", status=2)
    run("plan", "stair:rise", status=2)
    run("plan", "stair:rise=high", status=2)


def test_lists() -> None:
    assert [line.split()[0] for line in run("terrains").splitlines()] == terrains()
    assert [line.split()[0] for line in run("robots").splitlines()] == robots()


def test_help_is_quick_because_it_imports_nothing() -> None:
    code = (
        "import sys, stairwright.cli as c; c.parser().format_help(); "
        "print([m for m in ('numpy', 'mujoco', 'casadi', 'fastapi') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
    assert "certify" in run("--help")


def test_a_plan_is_summed_up_or_written(curb: Path, plan: Path) -> None:
    text = run("plan", curb, "--robot", "a1_wheeled_x", "--friction", "0.7")
    assert "feasible" in text
    assert "friction 0.7" in text
    document = json.loads(plan.read_text())
    assert document["schema"] == "stairwright/plan/1"
    assert document["robot"] == "a1_wheeled_x"


@pytest.mark.slow
def test_a_plan_is_certified_exported_and_rolled_out(plan: Path) -> None:
    assert "passed" in run("certify", plan)
    for name in ("csv", "npz", "mcap", "mjcf", "urdf"):
        out = plan.with_suffix(f".{name}")
        run("export", plan, "--format", name, "-o", out)
        assert out.stat().st_size > 500
    assert "success" in run("rollout", plan)
    rollout = plan.with_name("run.json")
    run("rollout", plan, "--seed", "4", "-o", rollout)
    assert json.loads(rollout.read_text())["seed"] == 4
    run("export", rollout, "--format", "html", "-o", plan.with_name("run.html"))


@pytest.mark.slow
def test_a_robot_and_a_plan_for_ros_are_written(curb: Path, plan: Path, tmp_path: Path) -> None:
    out = tmp_path / "robot.urdf"
    run("export", "a1_wheeled_x", "--format", "urdf", "-o", out)
    by_name = out.read_bytes()
    run("export", data_folder("robots") / "a1_wheeled_x.yaml", "-o", out)
    assert out.read_bytes() == by_name
    run("plan", curb, "--robot", "a1_wheeled_x", "-o", out)
    assert out.read_bytes() == by_name
    for rate in ("20", "200"):
        mcap = tmp_path / f"at-{rate}.mcap"
        run("export", plan, "-o", mcap, "--rate", rate)
    sizes = [(tmp_path / f"at-{rate}.mcap").stat().st_size for rate in ("20", "200")]
    assert sizes[1] > 2 * sizes[0]
    run("plan", curb, "-o", tmp_path / "plan.mcap", "--rate", "50")


def test_the_help_names_every_format() -> None:
    for command, kinds in (("plan", ["plan"]), ("rollout", ["rollout"]), ("export", FORMATS)):
        told = run(command, "--help")
        for kind in kinds:
            assert all(name in told for name in FORMATS[kind])


@pytest.mark.slow
def test_trials(plan: Path) -> None:
    out = plan.with_name("trials.json")
    status = main(["rollout", str(plan), "--trials", "2", "-o", str(out)])
    made = json.loads(out.read_text())
    assert made["count"] == 2
    assert status == (0 if made["successes"] == 2 else 1)
    assert sw.trials(load_mapping(plan), 2).model_dump(mode="json", by_alias=True) == made
    assert "1 of 1 succeeded" in run("rollout", plan, "--trials", "1")
    run("rollout", plan, "--trials", "2", "-o", "trials.csv", status=2)


@pytest.mark.slow
def test_what_cannot_be_done_is_status_1(tmp_path: Path) -> None:
    wall = tmp_path / "wall.json"
    wall.write_text(WALL)
    assert "infeasible" in run("plan", wall, status=1)
    out = tmp_path / "plan.json"
    run("plan", wall, "-o", out, status=1)
    assert json.loads(out.read_text())["status"] == "infeasible"
    run("rollout", wall, status=1)
    assert "FAILED" not in run("certify", out, status=1)  # as far as it goes it is sound
    told = io.StringIO()
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(told):
        main(["certify", str(out)])
    assert told.getvalue().startswith("stairwright: the plan is infeasible: ")


@pytest.mark.parametrize(
    ("points", "method", "told"),
    [
        ("[[0, 0], [0.1, 0], [0.1, 0.1], [2, 0.1]]", "path",
         "needs length 0.238 m, has 0.1 m: no place to stand at the start, the first flat "),
        ("[[-1, 0], [0, 0], [0, 1], [2, 1]]", "nominal", "needs friction 0.804, has 0.6: "),
    ],
)  # fmt: skip
def test_what_stops_the_robot_is_told_with_place_and_amount(
    points: str, method: str, told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    terrain = tmp_path / "terrain.json"
    terrain.write_text(f'{{"points": {points}}}')
    assert main(["plan", str(terrain), "--method", method]) == 1
    line = capsys.readouterr().err
    assert told in line
    assert " x = " in line


@pytest.mark.parametrize(
    "arguments",
    [
        (),
        ("dance",),
        ("plan",),
        ("plan", "nowhere"),
        ("plan", "missing.yaml"),
        ("plan", "missing.stl"),
        ("plan", "flat", "--robot", "nobody"),
        ("plan", "flat", "--friction", "nan"),
        ("plan", "flat", "--friction", "much"),
        ("plan", "flat", "--method", "magic"),
        ("plan", "flat", "--weight", "speed"),
        ("plan", "flat", "--weight", "beauty=1"),
        ("plan", "flat", "-o", "plan.docx"),
        ("plan", "flat", "-o", "/nowhere/plan.json"),
        ("rollout", "missing.json"),
        ("rollout", "flat", "--trials", "0"),
        ("rollout", "flat", "--seed", "-1"),
        ("certify", "missing.json"),
        ("export", "missing.json", "-o", "x.csv"),
        ("export", "a1_wheeled", "-o", "x.csv"),
        ("export", "a1_wheeled", "-o", "x.urdf", "--rate", "50"),
        ("plan", "flat", "-o", "x.mcap", "--rate", "5"),
        ("plan", "flat", "--rate", "50"),
        ("plan", "flat", "-o", "x.mcap", "--rate", "fast"),
        ("serve", "--host", "0.0.0.0"),
        ("serve", "--port", "99999"),
        ("bench", "--repeat", "0"),
        ("bench", "nope"),
        ("bench", "flat", "--robot", "nobody"),
    ],
)
def test_bad_input_is_status_2_and_one_line(arguments: tuple[str, ...]) -> None:
    assert run(*arguments, status=2) == ""


def test_a_cluster_that_cannot_go_on_is_status_1_and_one_line(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def lists(_: object) -> None:
        raise WorkerDied("the scheduler is gone")

    monkeypatch.setitem(commands.COMMANDS, "terrains", lists)
    run("terrains", status=1)


@pytest.mark.parametrize("command", ["study", "robot import", "certify"])
def test_an_unknown_option_leads_to_the_help_of_its_command(command: str) -> None:
    told = io.StringIO()
    with contextlib.redirect_stderr(told), pytest.raises(SystemExit):
        main([*command.split(), "a file", "--nonsense"])
    assert "unrecognized arguments: --nonsense" in told.getvalue()
    assert told.getvalue().endswith(f"(see stairwright {command} --help)\n")


def test_a_plan_that_is_made_already_takes_no_weights(plan: Path) -> None:
    run("rollout", plan, "--weight", "speed=0.2", status=2)


@pytest.mark.parametrize("command", ["serve", "rehearse plan.json"])
def test_a_port_that_cannot_be_is_told_by_its_flag(
    command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        main([*command.split(), "--port", "99999"])
    error = capsys.readouterr().err
    assert "--port: must be a number from 0 to 65535, not '99999'" in error
    assert "STAIRWRIGHT" not in error


def test_a_file_of_another_kind_is_told_what_it_is(
    plan: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = tmp_path / "study.yaml"
    study.write_text("schema: stairwright/study/1\n")
    for arguments, told in {
        f"plan {plan}": "is a plan (stairwright/plan/1), not a terrain",
        f"plan flat --robot {plan}": "is a plan (stairwright/plan/1), not a robot",
        f"certify {study}": "is a study (stairwright/study/1), not a plan",
        f"robot import {study}": "is a study (stairwright/study/1), not a robot",
        "plan flat --robot go2w.urdf": "makes a robot of it, in Python sw.import_robot",
    }.items():
        assert main(arguments.split()) == 2
        assert f"{told}\n" in capsys.readouterr().err, arguments


def test_a_port_in_use_is_bad_input() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        run("serve", "--port", str(taken.getsockname()[1]), status=2)


def test_a_table_is_a_terrain_too(tmp_path: Path) -> None:
    table = tmp_path / "curb.csv"
    table.write_text("x,z\n-1,0\n0,0\n0,0.05\n1,0.05\n")
    assert "feasible" in run("plan", table, "--method", "critical")


@pytest.mark.slow
def test_as_a_process_of_its_own() -> None:
    command = f"{sys.executable} -m stairwright terrains | head -1"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, check=False)
    assert done.stdout.startswith(terrains()[0])
    assert done.stderr == ""
    command = f"{sys.executable} -m stairwright plan nowhere"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("stairwright: no terrain is called 'nowhere'; there are: ")
    assert done.stderr.count("\n") == 1


@pytest.mark.slow
def test_bench() -> None:
    text = run("bench", "flat", "--robot", "a1_wheeled", "--repeat", "1")
    assert "median ms" in text
    assert "success" in text
