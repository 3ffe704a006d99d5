"""Compile to bytecode what a server imports: ``python -m stairwright.warmup``.

Run once after installation: some installers leave it for later, and some environments never let it
be written; each start then takes seconds longer.
"""

from __future__ import annotations

import importlib
import py_compile
import sys
from pathlib import Path

SERVED = (
    "uvicorn.main",
    "stairwright.api.app",
    "stairwright.scene.session",
    "stairwright.export.formats",
    "stairwright.planning.poses.critical_poses",
    "stairwright.planning.path",
    "stairwright.simulation.rollout",
)


def compile_bytecode() -> int:
    """Compile what a server imports to bytecode files where those are missing; how many.

    A folder that cannot be written is left alone.
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
    sys.stdout.write(f"{compile_bytecode()} modules were compiled to bytecode\n")
