"""Robots: presets, saved ones, imported ones, and files for other tools."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Annotated, Any, Literal

from fastapi import APIRouter, File, Form, Path, Query, Request, Response, UploadFile

from stairwright.api.bodies import RobotDocument
from stairwright.api.deps import JSON_BODY, Limit, Offset, Service
from stairwright.api.problems import describe
from stairwright.api.uploads import read_upload
from stairwright.export.table import ROBOT_FORMATS
from stairwright.jobs import robot_uploads
from stairwright.library import load_robot, robots
from stairwright.robot.description import MOST_HELD, Robot
from stairwright.robot.importing.holding import written_hold
from stairwright.robot.importing.report import Imported
from stairwright.sources import SentRobot

from . import stored
from .named import Named

router = APIRouter(prefix="/robots", tags=["robots"])
RobotName = Annotated[str, Path(min_length=1, max_length=100, pattern=r"^[\w .+-]+$")]
if TYPE_CHECKING:
    RobotFormat = str
else:
    RobotFormat = Literal[tuple(ROBOT_FORMATS)]


def _shown(robot: Robot, readonly: bool) -> RobotDocument:
    return RobotDocument(**robot.model_dump(), readonly=readonly, version=robot.hash)


NAMED = Named("robot", robots, load_robot, lambda services: services.store.robots, _shown)


@router.get("", response_model=list[RobotDocument])
def list_robots(
    request: Request, services: Service, limit: Limit = 1000, offset: Offset = 0
) -> Response:
    """All robots: presets first, then saved ones by name."""
    return NAMED.listing(request, services, limit, offset)


@router.post("/import", responses=describe(503))
async def import_robot(
    services: Service,
    file: Annotated[
        UploadFile, File(description="URDF, MJCF, a zip with the meshes, or our YAML or JSON")
    ],
    abduction: Annotated[
        float, Form(ge=-1.6, le=1.6, description="lock the legs outward from upright by [rad]")
    ] = 0.0,
    wheel_radius: Annotated[
        float | None, Form(gt=0.0, le=10.0, description="where the file does not show it [m]")
    ] = None,
    hold: Annotated[
        list[str] | None,
        Form(
            max_length=MOST_HELD,
            description="JOINT=RAD: a joint that is rigid there, by the file's name; may be given "
            "again",
        ),
    ] = None,
) -> Imported:
    """The robot in a file, what was assumed and what to know about it. It is not saved."""
    options: dict[str, Any] = {
        "abduction": abduction,
        "wheel_radius": wheel_radius,
        "hold": written_hold(hold or []),
    }
    known = [load_robot(each).model_dump(mode="json") for each in robots()]
    document = await read_upload(services, robot_uploads.import_robot, file, options, known)
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
    return NAMED.get(request, services, name)


@router.put(
    "/{name}",
    response_model=RobotDocument,
    dependencies=[JSON_BODY],
    responses={201: {"model": RobotDocument}, **describe(403, 409, 415)},
)
def put_robot(request: Request, services: Service, name: RobotName, body: SentRobot) -> Response:
    """Save a robot under a name; 201 if the name is new."""
    return NAMED.put(request, services, name, body.name, body)


@router.delete("/{name}", status_code=204, responses=describe(403, 404))
def delete_robot(services: Service, name: RobotName) -> None:
    """Remove a saved robot."""
    NAMED.delete(services, name)


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
    robot = await asyncio.to_thread(NAMED.find, services, name)
    return await stored.export_document(request, services, "robot", name, robot, format_name)
