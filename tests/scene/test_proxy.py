"""The WebSocket proxy on a real server with a real viser behind it."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Iterator
from pathlib import Path

import msgspec
import pytest
import uvicorn
import viser
import websockets
from fastapi import FastAPI, WebSocket
from websockets.asyncio.client import connect, unix_connect

from stairwright.scene.proxy import forwards, origin_allowed, proxy_websocket
from stairwright.scene.session import SceneSession
from tests.scene.example import example_plan

PROTOCOL = f"viser-v{viser.__version__}"


@pytest.fixture(scope="module")
def session() -> Iterator[SceneSession]:
    session = SceneSession("one")
    session.show(plan=example_plan(count=8).model_dump(mode="json"))
    yield session
    session.close()


@pytest.fixture(scope="module")
def address(session) -> Iterator[str]:
    app = FastAPI()

    @app.websocket("/scene/one")
    async def one(websocket: WebSocket) -> None:
        await proxy_websocket(websocket, session.address, {"http://editor.example"})

    @app.websocket("/scene/gone")
    async def gone(websocket: WebSocket) -> None:
        await proxy_websocket(websocket, Path("/nowhere"))

    server = uvicorn.Server(uvicorn.Config(app, host="127.0.0.1", port=0, log_level="warning"))
    thread = threading.Thread(target=server.run, daemon=True)
    thread.start()
    while not server.started:
        thread.join(0.02)
    port = server.servers[0].sockets[0].getsockname()[1]
    yield f"ws://127.0.0.1:{port}/scene"
    server.should_exit = True
    thread.join(20)


def talk(address: str, *, origin: str | None = None, send: tuple[bytes, ...] = ()) -> dict:
    options = {"subprotocols": [PROTOCOL], "origin": origin, "max_size": None}
    direct = address.startswith("/")

    async def run() -> dict:
        connecting = (
            unix_connect(address, **options) if direct else connect(address, proxy=None, **options)
        )
        async with connecting as socket:
            for message in send:
                await socket.send(message)
            first = await asyncio.wait_for(socket.recv(), 20)
            return {"protocol": socket.subprotocol, "first": first}

    return asyncio.run(run())


def test_the_scene_arrives_through_the_proxy(address):
    answer = talk(f"{address}/one")
    assert answer["protocol"] == PROTOCOL
    assert isinstance(answer["first"], bytes)
    assert len(answer["first"]) > 1000


@pytest.mark.parametrize(
    ("origin", "welcome"),
    [
        ("http://editor.example", True),
        ("http://evil.example", False),
        ("null", False),
        ("same", True),
    ],
)
def test_only_known_origins_may_connect(address, origin, welcome):
    if origin == "same":
        origin = "http://" + address.removeprefix("ws://").split("/")[0]
    if welcome:
        assert talk(f"{address}/one", origin=origin)["first"]
    else:
        with pytest.raises(websockets.InvalidStatus) as refused:
            talk(f"{address}/one", origin=origin)
        assert refused.value.response.status_code == 403


def test_a_share_tunnel_cannot_be_asked_for(address, session, monkeypatch):
    asked = threading.Event()
    monkeypatch.setattr(session._server, "request_share_url", lambda *a, **k: asked.set())
    request = msgspec.msgpack.encode({"type": "ShareUrlRequest"})
    talk(f"{address}/one", send=(request, b"\xc1 not msgpack", request))
    assert not asked.wait(0.5)
    # The same request straight to viser does reach it: the proxy is what holds it back.
    talk(str(session.address), send=(request,))
    assert asked.wait(20)


def test_a_scene_that_is_gone_refuses(address):
    with pytest.raises(websockets.InvalidStatus):
        talk(f"{address}/gone")


def test_a_closed_scene_closes_its_viewers_with_visers_code(address):
    """viser refuses a client of another version; its code and reason reach the browser."""

    async def run() -> tuple[int | None, str | None]:
        async with connect(
            f"{address}/one", subprotocols=["viser-v0.0.1"], max_size=None, proxy=None
        ) as socket:
            try:
                while True:
                    await asyncio.wait_for(socket.recv(), 20)
            except websockets.ConnectionClosed:
                return socket.close_code, socket.close_reason

    code, reason = asyncio.run(run())
    assert code == 1002
    assert "version" in (reason or "").lower()


def test_origin_rules():
    assert origin_allowed(None, "host:1", ())
    assert origin_allowed("https://host:1", "host:1", ())
    assert not origin_allowed("http://host:2", "host:1", ())
    assert not origin_allowed("http://host:1.evil", "host:1", ())
    assert origin_allowed("http://dev:5173", "host:1", {"http://dev:5173"})


def test_only_well_formed_binary_messages_pass():
    assert forwards(msgspec.msgpack.encode({"type": "ViewerCameraMessage"}))
    assert not forwards(msgspec.msgpack.encode({"type": "ShareUrlRequest"}))
    assert not forwards(msgspec.msgpack.encode([1, 2]))
    assert not forwards("text")
    assert not forwards(b"")
