"""What a process does before its first task, so that this task finds warm memory."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Iterator

from stairwright.errors import Cancelled
from stairwright.library import load_robot, robots

from .work import solve

GENTLE = {"name": "warm-up", "points": [[-1.0, 0.0], [0.0, 0.0], [0.0, 0.04], [1.0, 0.04]]}


def warm_plans() -> None:
    """Import and load what the first plan would otherwise wait for."""
    with _logged():
        from stairwright.planning.planner import plan

        plan(GENTLE, robots()[0], method="path")
        plan(GENTLE, robots()[0], method="critical")


def rehearse() -> None:
    """A small plan in a worker, so that the first one that counts meets warm memory.

    Raises:
        Exception: Whatever would keep other plans from being answered too.
    """
    robot = load_robot(robots()[0]).model_dump(mode="json")
    asked = {"friction": 0.6, "method": "path", "weights": {}}
    solve({"terrain": GENTLE, "robot": robot, **asked}, None)


def warm_rollouts() -> None:
    """The same for rollouts, which need only begin, and for the other robots."""
    with _logged():
        from stairwright.planning.planner import plan
        from stairwright.simulation.rollout import rollout

        for robot in robots():
            with contextlib.suppress(Cancelled):
                rollout(plan(GENTLE, robot, method="path"), progress=_give_up)
            plan(GENTLE, robot, method="critical")


def _give_up(_done: float) -> None:
    raise Cancelled


@contextlib.contextmanager
def _logged() -> Iterator[None]:
    """What fails while warming up will fail again, and be answered, where it is needed."""
    try:
        yield
    except Exception:
        logging.getLogger(__name__).exception("warming up failed")
