"""Robots: read-only, one document each."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path, Request, Response

from stairwright.api.deps import Limit, Offset
from stairwright.api.problems import describe, not_found
from stairwright.api.responses import model_json, models_json
from stairwright.library import load_robot, robots
from stairwright.robot.description import Robot

router = APIRouter(prefix="/robots", tags=["robots"])


@router.get("", response_model=list[Robot])
def list_robots(request: Request, limit: Limit = 1000, offset: Offset = 0) -> Response:
    """All robots."""
    shown = [load_robot(name) for name in robots()]
    page = shown[offset : offset + limit]
    return models_json(request, page, total=len(shown), limit=limit, offset=offset)


@router.get("/{name}", response_model=Robot, responses=describe(404))
def get_robot(request: Request, name: Annotated[str, Path(max_length=100)]) -> Response:
    """One robot."""
    if name not in robots():
        raise not_found("robot", name)
    return model_json(request, load_robot(name))
