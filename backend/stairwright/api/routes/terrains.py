"""Terrains: presets, saved ones, generated ones, imported ones."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import PurePath
from typing import Annotated, Any
from urllib.parse import quote

from fastapi import APIRouter, File, Form, Path, Request, Response, UploadFile
from pydantic import ValidationError

from stairwright.api.bodies import SentTerrain, TerrainDocument
from stairwright.api.deps import JSON_BODY, Limit, Offset, Service
from stairwright.api.problems import Problem, describe, from_validation, not_found
from stairwright.api.responses import model_json, models_json
from stairwright.api.services import UPLOAD_DEADLINE, Services
from stairwright.arguments import MOST_FRICTION
from stairwright.errors import InputError
from stairwright.jobs import uploads
from stairwright.jobs.failures import DeadlineExceeded, WorkerDied
from stairwright.library import load_terrain, terrains
from stairwright.terrain.generation import Generation, Name
from stairwright.terrain.generation import generate as make_terrain
from stairwright.terrain.mesh import Up
from stairwright.terrain.mesh_heights import MeshHeights
from stairwright.terrain.profile import Terrain

router = APIRouter(prefix="/terrains", tags=["terrains"])

TerrainName = Annotated[str, Path(min_length=1, max_length=100, pattern=r"^[\w .+-]+$")]
MOST_SAVED = 10_000


def _shown(terrain: Terrain, *, readonly: bool) -> TerrainDocument:
    return TerrainDocument(**terrain.model_dump(), readonly=readonly)


@router.get("", response_model=list[TerrainDocument])
def list_terrains(
    request: Request, services: Service, limit: Limit = 1000, offset: Offset = 0
) -> Response:
    """All terrains: presets first, then saved ones by name."""
    shown = [_shown(load_terrain(name), readonly=True) for name in terrains()]
    shown += [_shown(each, readonly=False) for each in services.store.terrains.all()]
    page = shown[offset : offset + limit]
    return models_json(request, page, total=len(shown), limit=limit, offset=offset)


@router.post("/generate", dependencies=[JSON_BODY], responses=describe(415))
def generate(body: Generation) -> Terrain:
    """A stair, a ramp or level ground from a few measures; it is not saved."""
    try:
        return make_terrain(body)
    except ValidationError as error:  # the measures are fine one by one, the terrain is not
        raise from_validation(error.errors()) from None


MeshFile = Annotated[UploadFile, File(description="STL, OBJ, PLY or OFF")]
Scale = Annotated[float, Form(gt=0.0, le=1e3, description="metres per unit of a mesh")]
Upward = Annotated[Up, Form(description="the axis of a mesh that points up")]


@router.post("/import", responses=describe(503))
async def import_terrain(
    services: Service,
    file: Annotated[UploadFile, File(description="STL, OBJ, PLY, OFF, CSV, JSON or YAML")],
    name: Annotated[Name | None, Form(description="the file's by default")] = None,
    friction: Annotated[float | None, Form(gt=0.0, le=MOST_FRICTION)] = None,
    x: Annotated[float, Form(ge=-1e6, le=1e6, description="of a mesh that becomes 0 [m]")] = 0.0,
    y: Annotated[
        float | None, Form(ge=-1e6, le=1e6, description="of the cut [m]; by default the middle")
    ] = None,
    heading: Annotated[float, Form(ge=-7.0, le=7.0, description="of the cut [rad]")] = 0.0,
    scale: Scale = 1.0,
    up: Upward = "z",
) -> Terrain:
    """The profile in a file; of a mesh, the upper edge of a vertical cut. It is not saved."""
    options: dict[str, Any] = {"heading": heading, "scale": scale, "up": up, "origin": (x, y)}
    if friction is not None:
        options["friction"] = friction
    file_name = PurePath(file.filename or "").name
    if name is not None:
        options["name"] = name
    elif PurePath(file_name).suffix.lower() not in (".json", ".yaml", ".yml"):
        options["name"] = _usable(PurePath(file_name).stem)
    return Terrain.model_validate(await _read(services, uploads.import_terrain, file, options))


@router.post("/import/heights", responses=describe(503))
async def get_mesh_heights(
    services: Service, file: MeshFile, scale: Scale = 1.0, up: Upward = "z"
) -> MeshHeights:
    """A mesh seen from above, to choose the cut by. Nothing is saved."""
    options = {"scale": scale, "up": up}
    return MeshHeights.model_validate(await _read(services, uploads.look_at_mesh, file, options))


async def _read(
    services: Services, reader: Callable[..., dict[str, Any]], file: UploadFile, options: Any
) -> dict[str, Any]:
    """What the sealed worker reads in a file."""
    suffix = PurePath(file.filename or "").suffix.lower()
    data = await file.read()
    try:
        async with services.uploading:
            return await services.upload_pool.run(
                reader, data, f"upload{suffix}", options, deadline=UPLOAD_DEADLINE
            )
    except (DeadlineExceeded, WorkerDied, MemoryError):
        raise InputError("takes too much time or memory to read", ("file",)) from None


def _usable(stem: str) -> str:
    """A terrain's name from a file's."""
    kept = "".join(c if c.isalnum() or c in " .+-_" else "-" for c in stem).strip()
    return kept[:100] or "imported"


@router.get("/{name}", response_model=TerrainDocument, responses=describe(404))
def get_terrain(request: Request, services: Service, name: TerrainName) -> Response:
    """One terrain."""
    return model_json(request, _find(services, name))


def _find(services: Services, name: str) -> TerrainDocument:
    if name in terrains():
        return _shown(load_terrain(name), readonly=True)
    saved = services.store.terrains.get(name)
    if saved is None:
        raise not_found("terrain", name)
    return _shown(saved, readonly=False)


@router.put(
    "/{name}",
    response_model=TerrainDocument,
    dependencies=[JSON_BODY],
    responses={201: {"model": TerrainDocument}, **describe(403, 409, 415)},
)
def put_terrain(
    request: Request, services: Service, name: TerrainName, body: SentTerrain
) -> Response:
    """Save a terrain under a name; 201 if the name is new."""
    _refuse_preset(name)
    if "name" in body.model_fields_set and body.name != name:
        raise InputError(f"the body says {body.name!r}, the address {name!r}", ("name",))
    if services.store.terrains.count() >= MOST_SAVED:
        raise Problem(409, f"{MOST_SAVED} terrains are saved already", kind="full")
    terrain = body.model_copy(update={"name": name})
    new = services.store.terrains.put(terrain)
    headers = {"location": quote(request.url.path)} if new else None
    return model_json(request, _shown(terrain, readonly=False), 201 if new else 200, headers)


@router.delete("/{name}", status_code=204, responses=describe(403, 404))
def delete_terrain(services: Service, name: TerrainName) -> None:
    """Remove a saved terrain."""
    _refuse_preset(name)
    if not services.store.terrains.delete(name):
        raise not_found("terrain", name)


def _refuse_preset(name: str) -> None:
    if name in terrains():
        raise Problem(403, f"{name!r} is a preset: save under another name", kind="read-only")
