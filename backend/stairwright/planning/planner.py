"""One door to all planning methods."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, get_args

from stairwright.arguments import as_friction
from stairwright.documents import Model
from stairwright.errors import InputError
from stairwright.library import load_robot, load_terrain
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain

from .plan import Method, Plan
from .weights import parse_weights

Source = str | os.PathLike[str] | Mapping[str, Any]


def plan(
    terrain: Source | Terrain,
    robot: Source | Robot = "a1_wheeled",
    friction: float | None = None,
    method: Method = "path",
    weights: Mapping[str, float] | Model | None = None,
    *,
    certified: bool = True,
) -> Plan:
    """Plan the poses of `robot` over `terrain`.

    Args:
        terrain: A preset's name, a file, a mapping or a `Terrain`.
        robot: A robot's name, a file, a mapping or a `Robot`.
        friction: Coulomb friction between wheel and terrain; the terrain's own by default.
        method: ``path`` (dense certified path), ``critical`` (the paper's poses) or ``nominal``
            (standing pose kept).
        weights: Cost weights by name, see `stairwright.planning.weights`.
        certified: Check single poses and the motion between them; without, ``critical`` is sooner.
            A path is always certified.

    Returns:
        The plan; infeasible terrain gives a plan with a `problem`, never an exception.

    Raises:
        InputError: If an argument is bad.
    """
    if method not in get_args(Method):
        raise InputError(
            f"unknown method {method!r}; there are: {', '.join(get_args(Method))}", ("method",)
        )
    ground = _within("terrain", load_terrain, terrain)
    machine = _within("robot", load_robot, robot)
    mu = ground.friction if friction is None else as_friction(friction)
    chosen = parse_weights(method, weights)
    if method == "path":
        from .path.planner import plan_path

        return plan_path(ground, machine, mu, chosen)
    if method == "critical":
        from .critical_poses import plan_critical

        return plan_critical(ground, machine, mu, chosen, certified=certified)
    from .nominal import plan_nominal

    return plan_nominal(ground, machine, mu, chosen)


def _within(field: str, load: Any, source: Any) -> Any:
    try:
        return load(source)
    except InputError as error:
        raise error.within(field) from None
