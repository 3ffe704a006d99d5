"""WebSocket between a browser and a session's viser server behind its Unix socket.

Checks the Origin (viser takes any), offers the client's subprotocols (viser checks its version by
them), and drops the request for a public share tunnel that any viewer could make.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any, Protocol

import msgspec
import websockets
from websockets.asyncio.client import ClientConnection, unix_connect
from websockets.typing import Subprotocol

log = logging.getLogger(__name__)

POLICY_VIOLATION, TRY_AGAIN_LATER = 1008, 1013
MAX_CLIENT_MESSAGE = 1 << 20  # bytes; camera and slider messages are below 2 kB
_BLOCKED = ("ShareUrlRequest", "ShareUrlDisconnect")


class BrowserSocket(Protocol):
    """What is needed of a Starlette or FastAPI WebSocket."""

    @property
    def headers(self) -> Mapping[str, str]:
        """Request headers, lower case."""

    @property
    def scope(self) -> Any:
        """ASGI scope."""

    async def accept(self, subprotocol: str | None = None) -> None:
        """Complete the handshake."""

    async def close(self, code: int = 1000, reason: str | None = None) -> None:
        """Close, or refuse when not yet accepted."""

    async def receive(self) -> Any:
        """Next ASGI message."""

    async def send_bytes(self, data: bytes) -> None:
        """Send one binary message."""

    async def send_text(self, data: str) -> None:
        """Send one text message."""


def origin_allowed(origin: str | None, host: str | None, allowed: Collection[str]) -> bool:
    """Whether a browser page of `origin` may connect: ours, or one that is listed.

    Without an Origin header the peer is no browser page and cannot act for a user.
    """
    if origin is None:
        return True
    if origin in allowed:
        return True
    return host is not None and origin in (f"http://{host}", f"https://{host}")


def forwards(message: bytes | str) -> bool:
    """Whether a viewer's message may reach viser: well formed and no request to open a tunnel."""
    if isinstance(message, str):
        return False  # viser's protocol is binary
    try:
        content = msgspec.msgpack.decode(message)
    except msgspec.DecodeError:
        return False
    return isinstance(content, dict) and content.get("type") not in _BLOCKED


async def proxy_websocket(
    websocket: BrowserSocket, address: Path, allowed_origins: Collection[str] = ()
) -> None:
    """Serve one viewer: connect `websocket` (not yet accepted) with viser at `address`.

    viser's client asks for its page's address without the closing slash, so that the route needs
    both forms: ``/scene/{id}`` and ``/scene/{id}/``.

    Args:
        websocket: The browser's side.
        address: `SceneSession.address`.
        allowed_origins: Origins beside the page's own host, e.g. ``http://localhost:5173``.
    """
    headers = websocket.headers
    if not origin_allowed(headers.get("origin"), headers.get("host"), allowed_origins):
        await websocket.close(code=POLICY_VIOLATION, reason="origin not allowed")
        return
    offered = [Subprotocol(name) for name in websocket.scope.get("subprotocols", [])]
    try:
        upstream = await unix_connect(
            str(address),
            subprotocols=offered or None,
            compression=None,
            max_size=None,
            open_timeout=5,
            ping_interval=None,
        )
    except (OSError, TimeoutError, websockets.WebSocketException):
        await websocket.close(code=TRY_AGAIN_LATER, reason="the scene is not running")
        return
    async with upstream:
        await websocket.accept(subprotocol=upstream.subprotocol)
        await _run_until_first_ends(
            _to_viser(websocket, upstream), _to_browser(websocket, upstream)
        )


async def _run_until_first_ends(*jobs: Any) -> None:
    tasks = [asyncio.ensure_future(job) for job in jobs]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        results = await asyncio.gather(*tasks, return_exceptions=True)
    for result in results:
        if isinstance(result, Exception) and not _is_disconnect(result):
            raise result


def _is_disconnect(error: Exception) -> bool:
    # Starlette raises RuntimeError or WebSocketDisconnect when the browser went away mid-send.
    return isinstance(error, (websockets.ConnectionClosed, RuntimeError, OSError)) or (
        type(error).__name__ == "WebSocketDisconnect"
    )


async def _to_viser(websocket: BrowserSocket, upstream: ClientConnection) -> None:
    while True:
        event = await websocket.receive()
        if event["type"] == "websocket.disconnect":
            await upstream.close(
                code=_sendable(event.get("code")), reason=event.get("reason") or ""
            )
            return
        message = event.get("bytes")
        if message is None:
            message = event.get("text") or ""
        if len(message) > MAX_CLIENT_MESSAGE:
            await upstream.close()
            await websocket.close(code=1009, reason="message too large")
            return
        if forwards(message):
            await upstream.send(message)
        else:
            log.warning("dropped a viewer's message that is not for viser")


async def _to_browser(websocket: BrowserSocket, upstream: ClientConnection) -> None:
    try:
        async for message in upstream:
            if isinstance(message, bytes):
                await websocket.send_bytes(message)
            else:
                await websocket.send_text(message)
    except websockets.ConnectionClosed:
        log.debug("viser closed the connection")
    await websocket.close(code=_sendable(upstream.close_code), reason=upstream.close_reason or "")


def _sendable(code: int | None) -> int:
    """A close code that may be sent: 1005, 1006 and 1015 are only ever reported."""
    if code is None or code in (1005, 1006, 1015) or not 1000 <= code < 5000:
        return 1000 if code in (None, 1005) else 1011
    return code
