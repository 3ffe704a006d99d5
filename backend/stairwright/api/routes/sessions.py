"""Sessions: a 3D scene for each browser page, steered by the page."""

from __future__ import annotations

import asyncio
import gzip
from typing import Annotated, Any

import orjson
from fastapi import APIRouter, Path, Response
from starlette.concurrency import run_in_threadpool

from stairwright.api.bodies import PlaybackRequest, SceneRequest, SessionDocument
from stairwright.api.deps import JSON_BODY, Idempotent, Service
from stairwright.api.problems import describe
from stairwright.api.services import Services
from stairwright.storage.documents import Kind

from . import stored

router = APIRouter(prefix="/sessions", tags=["sessions"])
SessionId = Annotated[str, Path(max_length=64)]


@router.post("", status_code=201, response_model=SessionDocument, responses=describe(409, 429, 503))
async def post_session(services: Service, once: Idempotent) -> Response:
    """Open a 3D scene; it closes by itself when nobody has used it for a while."""
    earlier = once.earlier if once.earlier and once.earlier in services.sessions else None
    name = earlier or await services.sessions.open()
    once.result = None if earlier else name
    shown = SessionDocument(id=name, scene=f"/scene/{name}/")
    headers = {"location": f"/api/v1/sessions/{name}"}
    return Response(shown.model_dump_json(), 201, headers, media_type="application/json")


@router.put(
    "/{session_id}/scene",
    status_code=204,
    dependencies=[JSON_BODY],
    responses=describe(404, 415),
)
async def put_scene(services: Service, session_id: SessionId, body: SceneRequest) -> None:
    """Show a plan, a rollout or both, and a second plan beside them; theme, layers or camera."""
    scene = services.sessions.get(session_id)
    given = body.model_fields_set
    if given & {"plan_id", "rollout_id"}:
        plan, rollout = await asyncio.gather(
            _load(services, "plan", body.plan_id), _load(services, "rollout", body.rollout_id)
        )
        await run_in_threadpool(scene.show, plan, rollout, body.theme, body.layers)
    elif given & {"theme", "layers"}:
        await run_in_threadpool(scene.set_view, body.theme, body.layers)
    if "compare_plan_id" in given and body.compare_plan_id != scene.compared:
        await run_in_threadpool(scene.compare, await _load(services, "plan", body.compare_plan_id))
    if body.camera is not None:
        await run_in_threadpool(scene.camera, body.camera)


@router.put(
    "/{session_id}/playback",
    status_code=204,
    dependencies=[JSON_BODY],
    responses=describe(404, 415),
)
async def put_playback(services: Service, session_id: SessionId, body: PlaybackRequest) -> None:
    """Set the scene's clock; between calls it runs on by itself."""
    scene = services.sessions.get(session_id)
    await run_in_threadpool(scene.playback, body.time, body.progress, body.playing, body.speed)


@router.delete("/{session_id}", status_code=204, responses=describe(404))
async def delete_session(services: Service, session_id: SessionId) -> None:
    """Close the scene."""
    await services.sessions.close(session_id)


async def _load(services: Services, kind: Kind, document_id: str | None) -> Any:
    if document_id is None:
        return None
    _, packed = await stored.load(services, kind, document_id)
    return await run_in_threadpool(lambda: orjson.loads(gzip.decompress(packed)))
