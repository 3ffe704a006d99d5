"""Which code answered: a stored answer counts only while the code that made it is unchanged."""

from __future__ import annotations

import hashlib
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from stairwright import _core

_PACKAGE = Path(__file__).resolve().parents[1]
_PLANNING = ("terrain", "robot", "planning")
_LIBRARIES = ("numpy", "casadi", "mujoco", "scipy", "shapely")


@cache
def planning_engine() -> str:
    """Fingerprint of everything that a plan depends on besides the question."""
    return _fingerprint(_PLANNING)


@cache
def rollout_engine() -> str:
    """The same for rollouts."""
    return _fingerprint((*_PLANNING, "control", "simulation"))


def _fingerprint(folders: tuple[str, ...]) -> str:
    total = hashlib.sha256(Path(_core.__file__).read_bytes())
    for folder in folders:
        for path in sorted((_PACKAGE / folder).rglob("*.py")):
            total.update(str(path.relative_to(_PACKAGE)).encode() + b"\0" + path.read_bytes())
    for library in _LIBRARIES:
        try:
            total.update(f"{library}={version(library)}".encode())
        except PackageNotFoundError:
            continue
    return total.hexdigest()[:16]
