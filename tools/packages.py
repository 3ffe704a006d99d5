"""Python's packages: the environment .venv, as the locks say."""

from __future__ import annotations

import contextlib
import importlib.util
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from .places import BENCH_LOCK, LOCKS, PYTHON, ROOT, STATE, UV_LOCK, VENV
from .running import SetupError, environment, run, say
from .steps import digest, step
from .system import apt_install

SLIM = ROOT / "slim.py"


def venv_python() -> str | None:
    """The version of the Python in .venv, None if there is none that runs."""
    with contextlib.suppress(OSError):
        command = [str(PYTHON), "-c", "import sys; print(sys.version, sys.prefix)"]
        answer = subprocess.run(command, check=False, capture_output=True, text=True)
        if answer.returncode == 0 and answer.stdout.strip().endswith(str(VENV)):
            return answer.stdout.strip()
    return None


def setup_uv() -> str:
    """The path of uv, which installs Python packages; it comes from PyPI where it is missing."""
    if (found := shutil.which("uv")) is not None:
        return found
    own = STATE / "uv"
    uv = own / "bin" / "uv"
    with step("uv", STATE / "uv.stamp", digest([UV_LOCK]), done=uv.is_file()) as needed:
        if needed:
            shutil.rmtree(own, ignore_errors=True)
            options = ("--quiet", "--require-hashes", "--no-deps", "--target", own, "-r", UV_LOCK)
            run(PYTHON, "-m", "pip", "install", *options)
    return str(uv)


def pip_install(*arguments: str | Path) -> str | None:
    """Install locked packages beside those that are there.

    Returns why that failed, which is the last line of what is shown; None if it did not.
    """
    options = ("--quiet", "--require-hashes", "--no-deps", "--python", PYTHON)
    command = (setup_uv(), "pip", "install", *options, *arguments)
    done = subprocess.run(
        command, cwd=ROOT, env=environment(), check=False, text=True, stderr=subprocess.PIPE
    )
    sys.stderr.write(done.stderr)
    if done.returncode == 0:
        return None
    return [f"exit status {done.returncode}", *done.stderr.strip().splitlines()][-1].strip()


def setup_python(locks: Sequence[Path]) -> None:
    """A virtual environment with at least the packages of `locks`, and the checkout itself.

    `locks` are the first of LOCKS. What `./dev studies` has installed stays.
    """
    if (running := venv_python()) is None:
        shutil.rmtree(VENV, ignore_errors=True)
        if importlib.util.find_spec("ensurepip") is None:
            package = f"python{sys.version_info.major}.{sys.version_info.minor}-venv"
            apt_install(package, purpose="Python's venv module is incomplete.")
        run(sys.executable, "-m", "venv", VENV)
        running = venv_python()
    stamp = VENV / ".locked"
    everything = digest([*LOCKS, SLIM], running, str(ROOT))
    wanted = digest([*locks, SLIM], running, str(ROOT))
    if stamp.is_file() and stamp.read_text() == everything:  # serving needs less than testing
        wanted = everything
    with step("Python packages", stamp, wanted) as needed:
        if needed:
            chosen = LOCKS[:2] if len(locks) == 1 and studies_stamp().is_file() else locks
            sync = (setup_uv(), "pip", "sync", "--quiet", "--python", PYTHON, "--require-hashes")
            run(*sync, *chosen)
            (VENV / ".installed").unlink(missing_ok=True)
            run(PYTHON, SLIM)
    package = digest([ROOT / "pyproject.toml", ROOT / "hatch_build.py"], running)
    with step("The package stairwright", VENV / ".installed", package) as needed:
        if needed:
            options = ("--no-deps", "--no-build-isolation", "--quiet", "--python", PYTHON)
            run(setup_uv(), "pip", "install", *options, "--editable", ROOT)


def studies_stamp() -> Path:
    """It is there once studies were asked for: what they need stays from then on."""
    return VENV / ".studies"


def setup_studies() -> None:
    """What studies need, beside what is there: a server that runs meanwhile is not disturbed."""
    wanted = digest([LOCKS[1], SLIM], venv_python(), str(ROOT))
    with step("What studies need", studies_stamp(), wanted) as needed:
        if needed:
            if why := pip_install("-r", LOCKS[1]):
                raise SetupError(f"What studies need cannot be installed: {why}")
            run(PYTHON, SLIM)


def setup_peers() -> None:
    """The packages that benchmarks compare with; one that cannot be installed is left out."""
    stamp, wanted = VENV / ".peers", digest([BENCH_LOCK, *LOCKS], venv_python())
    if stamp.is_file() and stamp.read_text() == wanted:
        return
    say("Packages that the benchmarks compare with ...")
    if pip_install("-r", BENCH_LOCK) is None:
        stamp.write_text(wanted)
    else:
        say("They cannot be installed here; the tables name what is missing.")
