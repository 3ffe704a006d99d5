"""Compile and load everything that a first question would wait for.

Run once at set-up (``python -m stairwright.warmup``), it fills numba's cache; run in the process
that workers are forked from, it makes each of them start warm.
"""

from __future__ import annotations

import sys
import time
from typing import get_args

from stairwright.library import robots
from stairwright.planning.plan import Method
from stairwright.planning.planner import plan
from stairwright.simulation.rollout import rollout

# Low enough for every robot and method, with a convex and a concave corner.
TERRAIN = {"name": "warm-up", "points": [[-1.0, 0.0], [0.0, 0.0], [0.0, 0.04], [1.0, 0.04]]}


def warm() -> None:
    """Plan with every robot and method, and roll a plan out; the likeliest question first.

    Raises:
        StairwrightError: If a planner refuses ground that it has to manage.
    """
    for method in get_args(Method):
        for robot in robots():
            made = plan(TERRAIN, robot, method=method)
            if method == "path" and len(made.poses) >= 2:
                rollout(made)


def main() -> int:
    """Warm up and say how long it took."""
    start = time.monotonic()
    warm()
    print(f"kernels are compiled ({time.monotonic() - start:.1f} s)", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
