"""Users without a home folder, as those of services are: it works, or says what to set."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import stairwright

STRANGER = ("unshare", "--user", "--map-user=12345")  # an id that no list of users knows
MORTAL = ("setpriv", "--bounding-set=-dac_override,-dac_read_search")  # root obeys permissions
IMPORTS = """
import stairwright.simulation.rollout
import stairwright.planning.planner
"""


def run(*command: str, cwd: Path | None = None, **variables: str) -> Any:
    """A command without HOME."""
    env = {k: v for k, v in os.environ.items() if k not in ("HOME", "XDG_DATA_HOME")} | variables
    return subprocess.run(command, env=env, cwd=cwd, capture_output=True, text=True)


def stranger() -> tuple[str, ...]:
    if run(*STRANGER, "true").returncode:
        pytest.skip("this system lets nobody be an unknown user")
    return STRANGER


def test_a_service_without_a_home_says_what_to_set() -> None:
    command = [sys.executable, "-m", "stairwright", "serve", "--port", "0"]
    done = run(*stranger(), *command)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1, done.stderr
    assert "STAIRWRIGHT_DATA" in done.stderr
    tilde = run(*stranger(), *command, STAIRWRIGHT_DATA="~nobody-of-this-name/data")
    assert tilde.returncode == 2
    assert "no such home" in tilde.stderr


@pytest.mark.slow
def test_a_service_without_a_home_works(start_server: Any, tmp_path: Path) -> None:
    """In systemd's folder for it; `test_installed.py` names one where there is no home."""
    data = tmp_path / "state"
    prefix = [*stranger(), "env", "-u", "HOME", "-u", "STAIRWRIGHT_DATA", f"STATE_DIRECTORY={data}"]
    with start_server(prefix=prefix):
        assert (data / "stairwright.sqlite").is_file()


@pytest.mark.slow
def test_a_folder_of_code_that_is_read_only_needs_no_home(tmp_path: Path) -> None:
    package = tmp_path / "stairwright"
    source = Path(stairwright.__file__).parent
    shutil.copytree(source, package, ignore=shutil.ignore_patterns("__pycache__"))
    for path in [package, *package.rglob("*")]:
        path.chmod(path.stat().st_mode & ~0o222)
    prefix = MORTAL if os.geteuid() == 0 else ()
    try:
        command = [*prefix, sys.executable, "-c", IMPORTS]
        done = run(*command, cwd=tmp_path, PYTHONPATH=str(tmp_path), HOME="/nonexistent")
    finally:
        for path in [package, *package.rglob("*")]:
            path.chmod(path.stat().st_mode | 0o200)
    assert done.returncode == 0, done.stderr
    assert not list(tmp_path.glob("~"))
