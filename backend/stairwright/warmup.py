"""Compile and cache everything that is compiled on first use: ``python -m stairwright.warmup``.

Run once after installation, so that no user waits for a compiler.
"""

from __future__ import annotations

import importlib.util
import sys
import time

from .library import load_robot, robots
from .planning.planner import plan
from .terrain.profile import Terrain

_STEP = Terrain(points=[(-1.2, 0.0), (0.0, 0.0), (0.0, 0.1), (1.2, 0.1)])
_WALL = Terrain(points=[(-1.2, 0.0), (0.0, 0.0), (0.0, 1.3), (1.2, 1.3)])


def warm_up() -> float:
    """Plan small courses with every robot, one impossible, and roll one out; returns seconds."""
    begun = time.perf_counter()
    for name in robots():
        plan(_STEP, load_robot(name))
    plan(_WALL, load_robot(robots()[0]))
    if importlib.util.find_spec("stairwright.simulation.rollout") is not None:
        from .simulation.rollout import rollout

        flat = Terrain(points=[(0.0, 0.0), (1.0, 0.0)])
        rollout(plan(flat, load_robot(robots()[0])))
    return time.perf_counter() - begun


if __name__ == "__main__":
    seconds = warm_up()
    sys.stdout.write(f"compiled code is warm ({seconds:.1f} s)\n")
