"""Robots: read-only, one document each."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path

from stairwright.api.problems import describe, not_found
from stairwright.library import load_robot, robots
from stairwright.robot.description import Robot

router = APIRouter(prefix="/robots", tags=["robots"])


@router.get("")
def list_robots() -> list[Robot]:
    """All robots."""
    return [load_robot(name) for name in robots()]


@router.get("/{name}", responses=describe(404))
def get_robot(name: Annotated[str, Path(max_length=100)]) -> Robot:
    """One robot."""
    if name not in robots():
        raise not_found("robot", name)
    return load_robot(name)
