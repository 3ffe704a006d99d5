"""Terrains: presets, saved ones, generated ones, imported ones."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, File, Form, Path, Request, Response, UploadFile

from stairwright.api.bodies import TerrainDocument
from stairwright.api.deps import JSON_BODY, Limit, Offset, Service
from stairwright.api.problems import describe
from stairwright.api.uploads import read_upload
from stairwright.arguments import MOST_FRICTION
from stairwright.jobs import uploads
from stairwright.library import load_terrain, terrains
from stairwright.sources import SentTerrain
from stairwright.terrain.generation import Generation, Name
from stairwright.terrain.generation import generate as make_terrain
from stairwright.terrain.mesh import Up
from stairwright.terrain.mesh_heights import MeshHeights
from stairwright.terrain.profile import Terrain

from .named import Named

router = APIRouter(prefix="/terrains", tags=["terrains"])

TerrainName = Annotated[str, Path(min_length=1, max_length=100, pattern=r"^[\w .+-]+$")]


def _shown(terrain: Terrain, readonly: bool) -> TerrainDocument:
    return TerrainDocument(**terrain.model_dump(), readonly=readonly)


NAMED = Named("terrain", terrains, load_terrain, lambda services: services.store.terrains, _shown)


@router.get("", response_model=list[TerrainDocument])
def list_terrains(
    request: Request, services: Service, limit: Limit = 1000, offset: Offset = 0
) -> Response:
    """All terrains: presets first, then saved ones by name."""
    return NAMED.listing(request, services, limit, offset)


@router.post("/generate", dependencies=[JSON_BODY], responses=describe(415))
def generate(body: Generation) -> Terrain:
    """A stair, a ramp or level ground from a few measures; it is not saved."""
    return make_terrain(body)


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
    options |= uploads.name_option(file.filename or "", name)
    document = await read_upload(services, uploads.import_terrain, file, options)
    return Terrain.model_validate(document)


@router.post("/import/heights", responses=describe(503))
async def get_mesh_heights(
    services: Service, file: MeshFile, scale: Scale = 1.0, up: Upward = "z"
) -> MeshHeights:
    """A mesh seen from above, to choose the cut by. Nothing is saved."""
    options = {"scale": scale, "up": up}
    document = await read_upload(services, uploads.look_at_mesh, file, options)
    return MeshHeights.model_validate(document)


@router.get("/{name}", response_model=TerrainDocument, responses=describe(404))
def get_terrain(request: Request, services: Service, name: TerrainName) -> Response:
    """One terrain."""
    return NAMED.get(request, services, name)


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
    said = body.name if "name" in body.model_fields_set else name
    document = body.model_copy(update={"name": name})
    return NAMED.put(request, services, name, said, document)


@router.delete("/{name}", status_code=204, responses=describe(403, 404))
def delete_terrain(services: Service, name: TerrainName) -> None:
    """Remove a saved terrain."""
    NAMED.delete(services, name)
