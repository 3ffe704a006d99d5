"""Robots: read-only, one document each, and files for other tools."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Annotated, Literal

from fastapi import APIRouter, Path, Query, Request, Response

from stairwright.api.deps import Limit, Offset, Service
from stairwright.api.problems import describe, not_found
from stairwright.api.responses import model_json, models_json
from stairwright.export.table import ROBOT_FORMATS
from stairwright.library import load_robot, robots
from stairwright.robot.description import Robot

from . import stored

router = APIRouter(prefix="/robots", tags=["robots"])
RobotName = Annotated[str, Path(max_length=100)]
if TYPE_CHECKING:
    RobotFormat = str
else:
    RobotFormat = Literal[tuple(ROBOT_FORMATS)]


@router.get("", response_model=list[Robot])
def list_robots(request: Request, limit: Limit = 1000, offset: Offset = 0) -> Response:
    """All robots."""
    shown = [load_robot(name) for name in robots()]
    page = shown[offset : offset + limit]
    return models_json(request, page, total=len(shown), limit=limit, offset=offset)


@router.get("/{name}", response_model=Robot, responses=describe(404))
def get_robot(request: Request, name: RobotName) -> Response:
    """One robot."""
    return model_json(request, _known(name))


@router.get(
    "/{name}/export",
    response_class=Response,
    responses={**stored.files(ROBOT_FORMATS), **describe(404, 429, 503)},
)
async def export_robot(
    request: Request,
    services: Service,
    name: RobotName,
    format_name: Annotated[RobotFormat, Query(alias="format")] = "urdf",
) -> Response:
    """One robot as a file for other tools."""
    robot = await asyncio.to_thread(_known, name)
    return await stored.export_document(request, services, "robot", name, robot, format_name)


def _known(name: str) -> Robot:
    if name not in robots():
        raise not_found("robot", name)
    return load_robot(name)
