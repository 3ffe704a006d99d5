"""Compile and cache everything that is compiled on first use: ``python -m stairwright.warmup``.

Run once after installation, so that no user waits for a compiler: neither for numba's, nor for
Python's own, which some installers leave for later and some environments never let write.
"""

from __future__ import annotations

import importlib
import importlib.util
import py_compile
import sys
import time
from pathlib import Path

from .library import load_robot, robots
from .planning.interpolation import reference
from .planning.planner import plan
from .terrain.profile import Terrain

SERVED = (
    "uvicorn.main",
    "stairwright.api.app",
    "stairwright.scene.session",
    "stairwright.export.formats",
)
_STEP = Terrain(points=[(-1.2, 0.0), (0.0, 0.0), (0.0, 0.1), (1.2, 0.1)])
_WALL = Terrain(points=[(-1.2, 0.0), (0.0, 0.0), (0.0, 1.3), (1.2, 1.3)])
# High enough to be out of clearance, low enough to be within reach: diagnosed by solving.
_LOW_WALL = Terrain(points=[(-1.2, 0.0), (0.0, 0.0), (0.0, 0.85), (1.2, 0.85)])


def warm_up() -> float:
    """Plan small courses with every robot, one impossible, and roll one out; returns seconds."""
    begun = time.perf_counter()
    warm_up_plans()
    if importlib.util.find_spec("stairwright.simulation.rollout") is not None:
        from .simulation.rollout import rollout

        flat = Terrain(points=[(0.0, 0.0), (1.0, 0.0)])
        rollout(plan(flat, load_robot(robots()[0])))
    return time.perf_counter() - begun


def warm_up_plans() -> None:
    """What a plan can need, whatever comes of it."""
    for name in robots():
        plan(_STEP, load_robot(name))
        reference(plan(_STEP, load_robot(name), method="critical"))
    plan(_WALL, load_robot(robots()[0]))
    for wall in (_WALL, _LOW_WALL):
        plan(wall, load_robot("a1_wheeled"), method="critical")


def compile_bytecode() -> int:
    """Compile what a server imports to bytecode files where those are missing; how many.

    Without them each start takes seconds longer. A folder that cannot be written is left alone.
    """
    for name in SERVED:
        importlib.import_module(name)
    made = 0
    for module in list(sys.modules.values()):
        spec = getattr(module, "__spec__", None)
        if spec is None or not spec.cached or not spec.origin or not spec.origin.endswith(".py"):
            continue
        if _is_fresh(Path(spec.cached), Path(spec.origin)):
            continue
        try:
            py_compile.compile(spec.origin, spec.cached, doraise=True)
        except (OSError, py_compile.PyCompileError):
            continue  # it was imported, so it works; only its bytecode cannot be kept
        made += 1
    return made


def _is_fresh(bytecode: Path, source: Path) -> bool:
    try:
        return bytecode.stat().st_mtime >= source.stat().st_mtime
    except OSError:
        return False


if __name__ == "__main__":
    seconds = warm_up()
    modules = compile_bytecode()
    sys.stdout.write(f"compiled code is warm ({seconds:.1f} s, {modules} modules)\n")
