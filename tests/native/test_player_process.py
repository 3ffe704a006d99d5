"""The player as a robot's computer runs it: built from a bundle, a process behind a socket."""

from __future__ import annotations

import contextlib
import shutil
import signal
import socket
import subprocess
import time
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

import stairwright as sw
from stairwright.cli import main
from stairwright.planning.plan import Plan
from stairwright.simulation.low_level import LowLevelRobot, pack_state, play, unpack_command

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(600),
    pytest.mark.skipif(
        not all(map(shutil.which, ("cmake", "c++"))), reason="needs CMake and a C++ compiler"
    ),
]
# Kept: what has changed of a bundle is built again.
UNPACKED = Path(__file__).parents[2] / ".dev" / "player"
PATIENT = ("--timeout", "10")  # of a machine that has other things to do


@pytest.fixture(scope="module")
def plan() -> Plan:
    stair = {"points": [(-0.9, 0.0), (0.0, 0.0), (0.0, 0.36), (0.9, 0.36)]}
    return sw.plan(stair, "go2w", friction=0.6)


def renew(place: Path, bundle: Path) -> None:
    """Have the bundle's files and no others at `place`, where those that are alike stay."""
    wanted = {path.relative_to(bundle) for path in bundle.rglob("*") if path.is_file()}
    for path in place.rglob("*"):
        name = path.relative_to(place)
        if path.is_file() and name.parts[0] != "build" and name not in wanted:
            path.unlink()
    for name in wanted:
        there, content = place / name, (bundle / name).read_bytes()
        if not there.is_file() or there.read_bytes() != content:
            there.parent.mkdir(parents=True, exist_ok=True)
            there.write_bytes(content)


@pytest.fixture(scope="module")
def program(plan: Plan, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The built player; its plan lies two folders above."""
    folder = tmp_path_factory.mktemp("bundle")
    plan.save(str(folder / "bundle.zip"))
    with zipfile.ZipFile(folder / "bundle.zip") as archive:
        archive.extractall(folder)
    top = UNPACKED
    renew(top, folder / "stairwright-go2w")
    options = ("-DSTAIRWRIGHT_PYTHON=OFF", "-DSTAIRWRIGHT_PLAYER=ON", "-DCMAKE_BUILD_TYPE=Debug")
    options += ("-DCMAKE_CXX_FLAGS_DEBUG=-O0",)  # nobody debugs it
    build = ("cmake", "-S", top / "native", "-B", top / "build", *options)
    subprocess.run(build, check=True, capture_output=True)
    subprocess.run(["cmake", "--build", top / "build", "-j2"], check=True, capture_output=True)
    return top / "build" / "stairwright_player"


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@contextmanager
def playing(program: Path, *options: str) -> Iterator[tuple[subprocess.Popen[str], int]]:
    port = free_port()
    command = [program, program.parents[1] / "plan.txt", "--port", str(port), *options]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        yield process, port
    finally:
        process.kill()
        process.wait()


class Link:
    """The robot's end, packet by packet; the robot stands still unless it acts."""

    def __init__(self, plan: Plan, port: int) -> None:
        self.robot, self.sequence = LowLevelRobot(plan), 0
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.connect(("127.0.0.1", port))
        self.socket.settimeout(10.0)

    def __enter__(self) -> Link:
        return self

    def __exit__(self, *_: object) -> None:
        self.socket.close()

    def tell(self, at: float | None = None) -> None:
        self.sequence += 1
        now = self.robot.run.time if at is None else at
        self.socket.send(pack_state(self.sequence, now, *self.robot.sense()))

    def hear(self) -> np.ndarray:
        return unpack_command(self.socket.recv(1024))[1]

    def wait_for_listener(self) -> None:
        for _ in range(200):
            try:
                self.tell()
                self.socket.settimeout(0.05)
                self.robot.act(self.hear())
            except (ConnectionRefusedError, TimeoutError):
                time.sleep(0.02)
            else:
                self.socket.settimeout(10.0)
                return
        raise AssertionError("nobody listens")

    def step(self) -> None:
        self.tell()
        self.robot.act(self.hear())


def test_the_check_says_what_is_in_the_plan(program: Path, plan: Plan) -> None:
    plan_file = program.parents[1] / "plan.txt"
    said = subprocess.run([program, plan_file, "--check"], capture_output=True, text=True)
    assert said.returncode == 0
    assert plan.id in said.stdout
    assert said.stdout.count("motor ") == 16
    for wrong in ([], ["--chek"], [plan_file, "--port"], [plan_file, "--port", "x"]):
        refused = subprocess.run([program, *wrong], capture_output=True, text=True)
        assert refused.returncode == 2
        assert "usage" in refused.stderr
    no_plan = subprocess.run([program, program], capture_output=True, text=True)
    assert no_plan.returncode == 2
    assert "line 1" in no_plan.stderr


def test_it_climbs_a_stair_that_it_only_feels(program: Path, plan: Plan) -> None:
    with playing(program, *PATIENT, "--stand", "0") as (process, port):
        played = play(LowLevelRobot(plan, seed=5), ("127.0.0.1", port))
        assert played.outcome == "success", played
        assert played.end_error < 0.02
        assert played.pitch_max > 0.3  # there was a stair
        out, _ = process.communicate(timeout=20)
    assert process.returncode == 0
    assert "the plan is done" in out


def test_the_command_line_plays_the_robot(
    program: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with playing(program, *PATIENT, "--stand", "0") as (_, port):
        plan_file = str(program.parents[1] / "plan.json")
        assert main(["rehearse", plan_file, "--port", str(port), "--seed", "2"]) == 0
    assert "success: Arrived" in capsys.readouterr().out


def test_another_robots_plan_is_refused_before_it_moves(program: Path) -> None:
    other = sw.plan("single-stair-036", "a1_wheeled", friction=0.6)
    with playing(program, *PATIENT) as (process, port), Link(other, port) as link:
        while process.poll() is None:
            with contextlib.suppress(ConnectionRefusedError):
                link.tell()
            time.sleep(0.02)
        out, _ = process.communicate(timeout=20)
        link.socket.setblocking(False)
        with pytest.raises((BlockingIOError, ConnectionRefusedError)):
            link.hear()
    assert process.returncode == 1
    assert "the plan begins at" in out


def test_a_dry_run_listens_and_sends_nothing(program: Path, plan: Plan) -> None:
    with (
        playing(program, "--dry-run", "--timeout", "1") as (process, port),
        Link(plan, port) as link,
    ):
        link.socket.setblocking(False)
        at = 0.0
        for _ in range(300):
            try:
                link.tell(at)
                at += 0.002
            except ConnectionRefusedError:
                assert process.poll() is None
            time.sleep(0.01)  # who is late by ten states has missed too many
            with pytest.raises((BlockingIOError, ConnectionRefusedError)):
                link.hear()
        out, _ = process.communicate(timeout=20)
    assert process.returncode == 3  # the states ended
    assert "legs" in out
    assert "0.0 %" in out
    assert "no new state for 1 s" in out


@pytest.mark.parametrize("frozen", [False, True])
def test_without_new_states_motors_damp_and_it_says_why(
    program: Path, plan: Plan, frozen: bool
) -> None:
    """States that stop, or that repeat themselves."""
    with playing(program, "--timeout", "0.5") as (process, port), Link(plan, port) as link:
        link.wait_for_listener()
        for _ in range(100):
            link.step()
        last, command = link.robot.run.time - link.robot.dt, None
        until = time.monotonic() + 10.0
        while time.monotonic() < until and (command is None or command[:, 3].any()):
            if frozen:
                link.tell(last)
                time.sleep(0.002)
            link.socket.settimeout(0.1)
            try:
                command = link.hear()
            except TimeoutError:
                continue
        assert command is not None
        assert not command[:, :4].any()
        assert (command[:, 4] > 0.0).all()
        out, _ = process.communicate(timeout=20)
    assert process.returncode == 3
    assert "no new state for 0.5 s" in out


def test_signals_pause_it_and_then_let_it_sink(program: Path, plan: Plan) -> None:
    with playing(program, *PATIENT) as (process, port), Link(plan, port) as link:
        link.wait_for_listener()
        while link.robot.run.time < 4.0:
            link.step()
        process.send_signal(signal.SIGINT)
        for _ in range(500):
            link.step()
        x = link.robot.run.data.qpos[0]
        for _ in range(1000):
            link.step()
        assert abs(link.robot.run.data.qpos[0] - x) < 2e-3
        process.send_signal(signal.SIGTERM)
        for _ in range(20):
            link.tell()
            command = link.hear()
            if not command[:, :4].any():
                break
            link.robot.act(command)
        assert not command[:, :4].any()
        out, _ = process.communicate(timeout=20)
    assert process.returncode == 128 + signal.SIGTERM
    assert "told to stop" in out


def test_packets_of_others_change_nothing(program: Path, plan: Plan) -> None:
    with playing(program, *PATIENT) as (process, port), Link(plan, port) as link:
        link.wait_for_listener()
        with Link(plan, port) as stranger:
            for k in range(200):
                stranger.socket.send([b"", b"SWS1", b"x" * 232, b"SWS1" + bytes(400)][k % 4])
                stranger.tell(99.0)
                link.step()
            stranger.socket.settimeout(0.05)
            with pytest.raises(TimeoutError):
                stranger.hear()
        assert process.poll() is None
