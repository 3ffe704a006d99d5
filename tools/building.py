"""Everything that serving and testing need, and the wheel."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from .native import setup_native
from .packages import setup_python, setup_studies, venv_python
from .page import setup_page
from .places import BACKEND, LOCKS, PYTHON, ROOT, STATE
from .running import NODE_MINIMUM, node_version, run
from .steps import digest, one_at_a_time, step
from .system import setup_library


def setup(locks: Sequence[Path] = LOCKS) -> None:
    """Everything that serving needs; with all locks what testing needs, too."""
    with one_at_a_time():
        setup_library("libgomp.so.1", "libgomp1", "The solver ProxQP needs GNU's OpenMP library.")
        build(locks)
        setup_bytecode()


def build(locks: Sequence[Path] = LOCKS[:1]) -> None:
    """Python's packages, then the native core; the page beside them, which waits for networks."""
    with ThreadPoolExecutor(1) as beside:
        early = node_version() >= NODE_MINIMUM  # else Node is a Python package
        page = beside.submit(setup_page) if early else None
        setup_python(locks)
        page = page or beside.submit(setup_page)
        setup_native()
        page.result()


def build_alone() -> None:
    """The page and the native core."""
    with one_at_a_time():
        build()


def setup_bytecode() -> None:
    """Compile the server's modules to bytecode now, so that its first start does not have to."""
    if not (BACKEND / "warmup.py").is_file():
        return
    wanted = digest([*BACKEND.rglob("*.py"), LOCKS[0]], venv_python())
    with step("Bytecode", STATE / "bytecode.stamp", wanted) as new:
        if new:
            run(PYTHON, "-m", "stairwright.warmup")


def studies() -> None:
    """Install what maps and designs need, into an environment that can serve."""
    with one_at_a_time():
        if venv_python() is None:
            setup_python(LOCKS[:1])
        setup_studies()


def wheel() -> None:
    """A wheel with the page and the native core inside, in dist/."""
    with one_at_a_time():
        build()
        run(PYTHON, "-m", "hatchling", "build", "--target", "wheel", "--directory", ROOT / "dist")
