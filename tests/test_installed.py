"""The wheel in an empty environment: no compiler, no home, nothing that can be written to."""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import time
import tomllib
from collections.abc import Callable, Iterator
from pathlib import Path

import httpx
import pytest
from packaging.requirements import Requirement

from tests.conftest import free_port

ROOT = Path(__file__).resolve().parents[1]
LARGEST = 500 * 2**20  # bytes of the whole environment, made smaller by slim.py
PATIENCE = 60.0  # s; on a quiet machine the first plan is there in less than 3
MORTAL = ("setpriv", "--bounding-set=-dac_override,-dac_read_search")  # root obeys permissions
PYTHON = Path("venv", "bin", "python")
pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]


def _run(*command: str | Path, cwd: Path = ROOT) -> None:
    done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]


def installer(python: Path) -> Callable[..., None]:
    """Installs what is locked; from uv's cache if everything is there."""
    own = ROOT / ".dev" / "uv" / "bin" / "uv"
    found = shutil.which("uv") or (str(own) if own.is_file() else None)

    def install(*what: str | Path) -> None:
        if found is None:
            _run(sys.executable, "-m", "pip", "--python", python, "install", "--no-deps", *what)
            return
        # compiled to bytecode, as pip does it
        command = [found, "pip", "install", "--no-deps", "--compile-bytecode", "--python", python]
        offline = subprocess.run([*command, "--offline", *what], check=False, capture_output=True)
        if offline.returncode != 0:
            _run(*command, *what)

    return install


def _without_build_tools() -> str:
    """What is locked, less what only building needs."""
    groups = tomllib.loads((ROOT / "pyproject.toml").read_text())["dependency-groups"]
    tools = {Requirement(text).name for text in groups["build"]}
    lock = (ROOT / "requirements.lock").read_text()
    blocks = re.findall(r"^\S.*\n(?:\s+.*\n)*", lock, flags=re.MULTILINE)
    return "".join(block for block in blocks if block.partition("==")[0] not in tools)


def _dependencies() -> Path:
    """A slim environment with what is locked and no more, kept for the next time."""
    lock = _without_build_tools()
    content = (lock + (ROOT / "slim.py").read_text() + sys.version).encode()
    folder = ROOT / ".dev" / f"installed-{hashlib.sha256(content).hexdigest()[:12]}"
    if not (folder / "complete").is_file():
        for old in folder.parent.glob("installed-*"):
            shutil.rmtree(old)
        _run(sys.executable, "-m", "venv", "--without-pip", folder / "venv")
        (folder / "requirements.lock").write_text(lock)
        locked = ("--require-hashes", "-r", folder / "requirements.lock")
        installer(folder / PYTHON)(*locked)
        _run(folder / PYTHON, ROOT / "slim.py")
        (folder / "complete").touch()
    return folder / "venv"


def _link(source: str, target: str) -> None:
    try:
        os.link(source, target)
    except OSError:  # on another disk
        shutil.copy2(source, target)


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A folder with an environment in `venv` that holds the wheel and cannot be written to."""
    if not (ROOT / "frontend" / "dist" / "index.html").is_file():
        pytest.fail("build the page first: ./dev build")
    folder = tmp_path_factory.mktemp("installed")
    hatchling = (sys.executable, "-m", "hatchling", "build", "--target", "wheel")
    _run(*hatchling, "--directory", folder)
    (wheel,) = folder.glob("*.whl")
    kept = _dependencies()
    shutil.copytree(kept, folder / "venv", symlinks=True, copy_function=_link)
    installer(folder / PYTHON)(wheel)
    _run(folder / PYTHON, ROOT / "slim.py")
    (packages,) = (folder / "venv").glob("lib/python*/site-packages")
    places = [packages, *(path for path in packages.rglob("*") if path.is_dir())]
    for place in places:
        place.chmod(0o555)
    yield folder
    for place in places:
        place.chmod(0o755)


def test_the_environment_is_small(installed: Path) -> None:
    files = [path.lstat() for path in (installed / "venv").rglob("*")]
    taken = {status.st_ino: status.st_blocks * 512 for status in files}
    print(f"{sum(taken.values()) / 2**20:.0f} MB")
    assert sum(taken.values()) < LARGEST


def _environment(folder: Path) -> dict[str, str]:
    """Nothing on the path, no home: what a service of a small system has."""
    empty = folder / "bin"
    empty.mkdir(exist_ok=True)
    return {"PATH": str(empty), "STAIRWRIGHT_DATA": str(folder / "data"), "HOME": "/nonexistent"}


def _command(folder: Path, *arguments: str) -> list[str]:
    prefix = list(MORTAL) if os.geteuid() == 0 else []
    prefix[:1] = [path for name in prefix[:1] if (path := shutil.which(name))]
    return [*prefix, str(folder / PYTHON), "-m", "stairwright", *arguments]


def _first_plan(api: str, process: subprocess.Popen[bytes]) -> httpx.Response:
    """The answer to a plan that is asked for as soon as anybody listens."""
    give_up = time.monotonic() + PATIENCE
    while True:
        try:
            return httpx.post(
                f"{api}/plans", json={"terrain": "single-stair-036"}, timeout=PATIENCE
            )
        except httpx.ConnectError:
            assert process.poll() is None, "the server has ended"
            assert time.monotonic() < give_up
            time.sleep(0.02)


def test_it_serves_its_first_plan_and_its_page_at_once(
    installed: Path, record_property: Callable[[str, object], None]
) -> None:
    port = str(free_port())
    begun = time.monotonic()
    with (installed / "log").open("wb") as log:
        process = subprocess.Popen(
            _command(installed, "serve", "--port", port),
            cwd=installed,
            env=_environment(installed),
            stdout=log,
            stderr=subprocess.STDOUT,
        )
    try:
        answer = _first_plan(f"http://127.0.0.1:{port}/api/v1", process)
        seconds = time.monotonic() - begun
        page = httpx.get(f"http://127.0.0.1:{port}/", timeout=PATIENCE)
    finally:
        process.terminate()
        process.wait(15)
    record_property("seconds_to_the_first_plan", seconds)
    print(f"first plan after {seconds:.2f} s")
    assert answer.status_code == 200, answer.text[:2000]
    assert answer.json()["status"] == "feasible"
    assert "text/html" in page.headers["content-type"]
    assert seconds < PATIENCE


def test_the_command_plans_rolls_out_and_exports(installed: Path) -> None:
    env = _environment(installed)

    def stairwright(*arguments: str) -> str:
        begun = time.monotonic()
        done = subprocess.run(
            _command(installed, *arguments), cwd=installed, env=env, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        print(f"{arguments[0]}: {time.monotonic() - begun:.2f} s")
        return done.stdout

    assert "single-stair-036" in stairwright("terrains")
    stairwright("plan", "single-stair-036", "-o", "plan.json")
    stairwright("plan", "single-stair-036", "--method", "critical", "-o", "poses.csv")
    stairwright("plan", "single-stair-036", "--method", "critical", "--solver", "ipopt")
    stairwright("rollout", "plan.json", "-o", "run.html")
    stairwright("export", "a1_wheeled", "-o", "robot.urdf")
    stairwright("export", "plan.json", "-o", "plan.mcap")
    assert json.loads((installed / "plan.json").read_text())["status"] == "feasible"
    assert (installed / "run.html").stat().st_size > 100_000
