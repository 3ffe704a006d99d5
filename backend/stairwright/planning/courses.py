"""Planners kept from one question to the next, for who asks many in turn, as a study does.

Where only the friction is another, the curve of wheel centres, the stands and the tables of
searches over the whole course are there already. Answers are the same to the last bit.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import replace

from stairwright.planning.path_planner import PathPlanner, path_planner
from stairwright.planning.weights import PathWeights
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain

_KEPT = 8  # robots of one terrain: as many as knees that bend both ways make of one, either way


class Courses:
    """The last terrain's planners."""

    def __init__(self) -> None:
        self._terrain = ""
        self._planners: dict[tuple[str, PathWeights], PathPlanner] = {}

    def planner(
        self, terrain: Terrain, robot: Robot, friction: float, weights: PathWeights, *, fast: bool
    ) -> PathPlanner:
        """See `path_planner`."""
        if self._terrain != terrain.hash or len(self._planners) > _KEPT:
            self._terrain, self._planners = terrain.hash, {}
        key = robot.hash, weights
        known = self._planners.get(key)
        if known is None:
            made = path_planner(terrain, robot, friction, weights, fast=fast)
        else:
            begin, end = known.ends
            whole = {
                at: search
                for at, search in known.searches.copy().items()
                if search.begin is begin and search.end is end
            }
            made = replace(
                known, terrain=terrain, robot=robot, friction=friction, fast=fast, searches=whole
            )
        self._planners[key] = made
        return made


_kept: ContextVar[Courses | None] = ContextVar("courses", default=None)


@contextmanager
def kept_in(courses: Courses) -> Iterator[None]:
    """Within this, plans begin with what `courses` has, and leave there what they made."""
    token = _kept.set(courses)
    try:
        yield
    finally:
        _kept.reset(token)


def courses() -> Courses:
    """Those of `kept_in`; else none that are known."""
    return _kept.get() or Courses()
