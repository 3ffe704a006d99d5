"""Robots: presets, saved ones, imported ones, and files for other tools."""

from __future__ import annotations

import asyncio
from pathlib import PurePath
from typing import TYPE_CHECKING, Annotated, Any, Literal
from urllib.parse import quote

from fastapi import APIRouter, File, Form, Path, Query, Request, Response, UploadFile

from stairwright.api.bodies import RobotDocument, SentRobot
from stairwright.api.deps import JSON_BODY, Limit, Offset, Service
from stairwright.api.problems import Problem, describe, not_found
from stairwright.api.responses import model_json, models_json
from stairwright.api.services import UPLOAD_DEADLINE, Services
from stairwright.errors import InputError
from stairwright.export.table import ROBOT_FORMATS
from stairwright.jobs import robot_uploads
from stairwright.jobs.failures import DeadlineExceeded, WorkerDied
from stairwright.library import load_robot, robots
from stairwright.robot.description import Robot
from stairwright.robot.importing.report import Imported

from . import stored

router = APIRouter(prefix="/robots", tags=["robots"])
RobotName = Annotated[str, Path(min_length=1, max_length=100, pattern=r"^[\w .+-]+$")]
MOST_SAVED = 10_000
if TYPE_CHECKING:
    RobotFormat = str
else:
    RobotFormat = Literal[tuple(ROBOT_FORMATS)]


def _shown(robot: Robot, *, readonly: bool) -> RobotDocument:
    return RobotDocument(**robot.model_dump(), readonly=readonly, version=robot.hash)


@router.get("", response_model=list[RobotDocument])
def list_robots(
    request: Request, services: Service, limit: Limit = 1000, offset: Offset = 0
) -> Response:
    """All robots: presets first, then saved ones by name."""
    shown = [_shown(load_robot(name), readonly=True) for name in robots()]
    shown += [_shown(each, readonly=False) for each in services.store.robots.all()]
    page = shown[offset : offset + limit]
    return models_json(request, page, total=len(shown), limit=limit, offset=offset)


@router.post("/import", responses=describe(503))
async def import_robot(
    services: Service,
    file: Annotated[UploadFile, File(description="URDF, MJCF, or a zip with the meshes")],
    abduction: Annotated[
        float, Form(ge=-1.6, le=1.6, description="lock the legs outward from upright by [rad]")
    ] = 0.0,
    wheel_radius: Annotated[
        float | None, Form(gt=0.0, le=10.0, description="where the file does not show it [m]")
    ] = None,
) -> Imported:
    """The robot in a file, what was assumed and what to know about it. It is not saved."""
    options: dict[str, Any] = {"abduction": abduction, "wheel_radius": wheel_radius}
    name = PurePath(file.filename or "").name
    known = [load_robot(each).model_dump(mode="json") for each in robots()]
    data = await file.read()
    try:
        async with services.uploading:
            document = await services.upload_pool.run(
                robot_uploads.import_robot, data, name, options, known, deadline=UPLOAD_DEADLINE
            )
    except (DeadlineExceeded, WorkerDied, MemoryError):
        raise InputError("takes too much time or memory to read", ("file",)) from None
    return Imported.model_validate(document)


@router.post(
    "/export",
    response_class=Response,
    dependencies=[JSON_BODY],
    responses={**stored.files(ROBOT_FORMATS), **describe(415, 429, 503)},
)
async def export_sent_robot(
    request: Request,
    services: Service,
    body: SentRobot,
    format_name: Annotated[RobotFormat, Query(alias="format")] = "urdf",
) -> Response:
    """A robot that need not be saved, as a file for other tools."""
    return await stored.export_document(request, services, "robot", body.name, body, format_name)


@router.get("/{name}", response_model=RobotDocument, responses=describe(404))
def get_robot(request: Request, services: Service, name: RobotName) -> Response:
    """One robot."""
    return model_json(request, _find(services, name))


@router.put(
    "/{name}",
    response_model=RobotDocument,
    dependencies=[JSON_BODY],
    responses={201: {"model": RobotDocument}, **describe(403, 409, 415)},
)
def put_robot(request: Request, services: Service, name: RobotName, body: SentRobot) -> Response:
    """Save a robot under a name; 201 if the name is new."""
    _refuse_preset(name)
    if body.name != name:
        raise InputError(f"the body says {body.name!r}, the address {name!r}", ("name",))
    if services.store.robots.count() >= MOST_SAVED:
        raise Problem(409, f"{MOST_SAVED} robots are saved already", kind="full")
    new = services.store.robots.put(body)
    headers = {"location": quote(request.url.path)} if new else None
    return model_json(request, _shown(body, readonly=False), 201 if new else 200, headers)


@router.delete("/{name}", status_code=204, responses=describe(403, 404))
def delete_robot(services: Service, name: RobotName) -> None:
    """Remove a saved robot."""
    _refuse_preset(name)
    if not services.store.robots.delete(name):
        raise not_found("robot", name)


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
    robot = await asyncio.to_thread(_known, services, name)
    return await stored.export_document(request, services, "robot", name, robot, format_name)


def _find(services: Services, name: str) -> RobotDocument:
    return _shown(_known(services, name), readonly=name in robots())


def _known(services: Services, name: str) -> Robot:
    if name in robots():
        return load_robot(name)
    saved = services.store.robots.get(name)
    if saved is None:
        raise not_found("robot", name)
    return saved


def _refuse_preset(name: str) -> None:
    if name in robots():
        raise Problem(403, f"{name!r} is a preset: save under another name", kind="read-only")
