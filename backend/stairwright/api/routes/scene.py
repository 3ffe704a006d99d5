"""The 3D scene itself: viser's client, and its WebSocket handed on to the session's server."""

from __future__ import annotations

from fastapi import APIRouter, WebSocket
from starlette.concurrency import run_in_threadpool
from starlette.responses import HTMLResponse, RedirectResponse, Response

from stairwright.api.deps import Service
from stairwright.api.problems import Problem
from stairwright.api.services import Services

router = APIRouter(prefix="/scene", include_in_schema=False)


@router.get("/{session_id}")
async def without_slash(session_id: str, services: Service) -> Response:
    """The client looks for its WebSocket below its own address, which ends with a slash."""
    services.sessions.get(session_id)
    return RedirectResponse(f"/scene/{session_id}/")


@router.get("/{session_id}/")
async def client(session_id: str, services: Service) -> Response:
    """Viser's client for this session."""
    scene = services.sessions.get(session_id)
    page = await run_in_threadpool(scene.client_html, f"/scene/{session_id}/")
    headers = {
        "cache-control": "no-store",
        # Who may frame it, which the policy within the document cannot say.
        "content-security-policy": "frame-ancestors 'self'",
        "referrer-policy": "no-referrer",  # the address is the secret
    }
    return HTMLResponse(page, headers=headers)


@router.websocket("/{session_id}")
@router.websocket("/{session_id}/")
async def proxy(websocket: WebSocket, session_id: str) -> None:
    """One viewer. The gate has checked its Origin already."""
    services: Services = websocket.app.state.services
    try:
        scene = services.sessions.get(session_id)
    except Problem:
        await websocket.close(code=1008, reason="there is no such session")
        return
    from stairwright.scene.proxy import proxy_websocket

    origin = websocket.headers.get("origin")
    await proxy_websocket(websocket, scene.address, {origin} if origin else set())
