"""Check, test and measure."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor

from .building import setup
from .packages import setup_peers, venv_python
from .page import npm
from .places import LOCKS, PYTHON, ROOT, STATE
from .running import environment, say, succeeds
from .steps import digest, step
from .system import setup_browser

MOST_TEST_PROCESSES = 4  # each has a server and a browser of its own


def check() -> list[str]:
    """Lint and type-check all code, all at once; the names of the checks that failed."""
    say("Lint and types ...")
    checks: dict[str, Callable[[], bool]] = {
        "ruff": lambda: succeeds(PYTHON, "-m", "ruff", "check", "--quiet"),
        "ruff format": lambda: succeeds(PYTHON, "-m", "ruff", "format", "--check", "--quiet"),
        "mypy": lambda: succeeds(PYTHON, "-m", "mypy"),
        "Biome and tsc": lambda: npm("run", "--silent", "check"),
    }
    with ThreadPoolExecutor() as pool:
        passed = list(pool.map(lambda passes: passes(), checks.values()))
    return [name for name, fine in zip(checks, passed, strict=True) if not fine]


def check_alone() -> int:
    """The same after the set-up; 0 if all passed."""
    setup()
    return 1 if check() else 0


def setup_tests() -> None:
    """Compile what tests import to bytecode: once, and not in each of their processes."""
    with step("Bytecode of the tests", STATE / "tests.stamp", digest(LOCKS, venv_python())) as new:
        if new:
            command = (PYTHON, "-m", "pytest", "--collect-only")
            subprocess.run(command, cwd=ROOT, env=environment(), check=False, capture_output=True)


def test(arguments: Sequence[str]) -> int:
    """Run the tests; 0 if all of them and the lint passed."""
    quick = list(arguments) in (["--quick"], ["-q"])
    whole = not arguments
    setup()
    variables = {"OPENBLAS_NUM_THREADS": "1"}  # as workers and the command have it
    if not quick:
        variables["STAIRWRIGHT_BROWSER"] = setup_browser()
    if whole or quick:
        # Slow tests wait for servers and browsers now and then: one process more than cores.
        processes = min((os.cpu_count() or 1) + (not quick), MOST_TEST_PROCESSES)
        shared = ["-n", str(processes)]
        arguments = shared + (["-m", "not slow and not browser"] if quick else [])
    failed: list[str] = []
    if whole or quick:
        with ThreadPoolExecutor(1) as beside:
            ready = beside.submit(setup_tests)
            failed = check()
            ready.result()
    if failed:
        say(f"FAILED: {', '.join(failed)} (the tests run nevertheless)")
    say("Tests ...")
    passed = succeeds(PYTHON, "-m", "pytest", *arguments, env=variables)
    if failed:
        say(f"FAILED: {', '.join(failed)}; see above the tests")
    return 0 if passed and not failed else 1


def bench(arguments: Sequence[str]) -> int:
    """Run the benchmarks; the browser is needed for the one that drags."""
    setup()
    setup_peers()
    variables = {"STAIRWRIGHT_BROWSER": setup_browser()}
    return 0 if succeeds(PYTHON, "benchmarks/run.py", *arguments, env=variables) else 1


def atlas(arguments: Sequence[str]) -> int:
    """Compute and draw how far each preset robot goes."""
    setup()
    return 0 if succeeds(PYTHON, "benchmarks/atlas.py", *arguments) else 1
