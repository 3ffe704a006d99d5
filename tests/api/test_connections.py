"""Connections that do not get on are closed, and whoever opens too many keeps nobody else out."""

from __future__ import annotations

import asyncio
import contextlib
import ipaddress
import json
import resource
import socket
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from urllib.parse import urlsplit

import httpx
import pytest
import websockets
from starlette.responses import PlainTextResponse
from starlette.types import Receive, Scope, Send
from websockets.asyncio.client import connect

from stairwright.api.addresses import Network
from stairwright.api.connections import Bounds, bounded
from tests.conftest import Server
from tests.in_process import served

Start = Callable[..., contextlib.AbstractContextManager[Server]]
LIMIT = 20
HALF_A_HEAD = b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nX-"
HALF_A_BODY = (
    b"POST /api/v1/plans HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
    b'Content-Length: 5000\r\n\r\n{"terr'
)
PATIENCE = 60.0  # s

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def hasty(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A server that waits a second for a request, and takes twenty connections of an address."""
    from tests.conftest import serve

    data = tmp_path_factory.mktemp("hasty") / "data"
    settings = {
        "STAIRWRIGHT_RECEIVE_TIMEOUT": "1",
        "STAIRWRIGHT_KEEP_ALIVE": "1",
        "STAIRWRIGHT_CONNECTIONS": str(LIMIT),
    }
    with serve(data, **settings) as server:
        yield server


def dial(server: Server, sent: bytes, source: str = "127.0.0.1") -> socket.socket:
    address = urlsplit(server.url)
    target = (address.hostname or "", address.port or 0)
    connection = socket.create_connection(target, PATIENCE, source_address=(source, 0))
    connection.sendall(sent)
    return connection


def rest(connection: socket.socket) -> bytes:
    """All that still comes, until the server closes."""
    answer = b""
    with contextlib.suppress(ConnectionResetError):
        while part := connection.recv(65536):
            answer += part
    connection.close()
    return answer


def get(server: Server, source: str, **options: object) -> httpx.Response:
    with httpx.Client(
        transport=httpx.HTTPTransport(local_address=source), timeout=PATIENCE
    ) as client:
        return client.get(f"{server.url}/api/v1/terrains/flat", **options)  # type: ignore[arg-type]


def test_half_sent_requests_are_given_up(hasty: Server) -> None:
    sent = [HALF_A_HEAD] * 6 + [HALF_A_BODY] * 6 + [b"P", b"\r\n"]
    for connection in [dial(hasty, each) for each in sent]:
        answer = rest(connection)
        assert answer.startswith(b"HTTP/1.1 408 ")
        head, body = answer.split(b"\r\n\r\n")
        assert b"connection: close" in head
        assert json.loads(body)["status"] == 408
    assert rest(dial(hasty, b"")) == b""  # a browser's spare connection: nobody waits for a word


def test_a_second_request_on_a_connection_has_to_arrive_too(hasty: Server) -> None:
    whole = b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n"
    answer = rest(dial(hasty, whole + whole + HALF_A_HEAD))
    assert answer.count(b"HTTP/1.1 200 ") == 2
    assert answer.count(b"HTTP/1.1 408 ") == 1
    assert rest(dial(hasty, whole)).count(b"HTTP/1.1") == 1  # and an idle one is closed


def test_a_body_that_keeps_coming_may_take_long(hasty: Server) -> None:
    body = b'{"terrain": "no-such"' + b" " * 150_000 + b"}"
    head = b"POST /api/v1/plans HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
    head += b"Connection: close\r\nContent-Length: %d\r\n\r\n" % len(body)
    with dial(hasty, head) as connection:
        for start in range(0, len(body), 10_000):
            connection.sendall(body[start : start + 10_000])
            time.sleep(0.15)
        assert rest(connection).startswith(b"HTTP/1.1 422 ")


def test_an_answer_that_is_refused_early_frees_the_connection(hasty: Server) -> None:
    """A refusal comes before the body; the rest of the body has to come in time all the same."""
    refused = HALF_A_BODY.replace(b"localhost", b"evil.example")
    answer = rest(dial(hasty, refused))
    assert answer.startswith(b"HTTP/1.1 421 ")
    assert answer.count(b"HTTP/1.1 ") == 1


def test_an_endless_head_is_refused(hasty: Server) -> None:
    with contextlib.suppress(ConnectionError):
        connection = dial(hasty, HALF_A_HEAD + b"a" * 70_000)
        assert rest(connection).startswith(b"HTTP/1.1 431 ")


def test_who_holds_connections_open_keeps_nobody_out(hasty: Server) -> None:
    held = [dial(hasty, HALF_A_HEAD if k % 2 else b"") for k in range(20 * LIMIT)]
    assert get(hasty, "127.0.0.1").status_code == 200
    assert get(hasty, "127.0.0.2").status_code == 200
    for connection in held:
        rest(connection)


def test_beyond_the_limit_an_address_is_refused_and_others_are_not(hasty: Server) -> None:
    live = hasty.url.replace("http", "ws") + "/api/v1/plans/live"

    async def crowd() -> tuple[int, str, int]:
        async with contextlib.AsyncExitStack() as stack:
            for _ in range(LIMIT):
                await stack.enter_async_context(connect(live))
            with pytest.raises(websockets.InvalidStatus) as refused:
                await connect(live)
            other = await asyncio.to_thread(get, hasty, "127.0.0.2")
            answer = refused.value.response
            return answer.status_code, answer.headers["retry-after"], other.status_code

    assert asyncio.run(crowd()) == (429, "1", 200)


def test_all_addresses_together_leave_descriptors_for_files(start_server: Start) -> None:
    """The server raises its limit itself; where that is low, half of it is for connections."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(soft, 1024), hard))
    try:
        with start_server(STAIRWRIGHT_CONNECTIONS="100000") as server:
            limits = Path(f"/proc/{server.process.pid}/limits").read_text()
            (line,) = [each for each in limits.splitlines() if each.startswith("Max open files")]
            assert int(line.split()[3]) == min(hard, 65536)
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


@pytest.mark.parametrize("proxies", [(), (ipaddress.ip_network("127.0.0.0/8"),)])
def test_connections_are_bounded_in_all(proxies: tuple[Network, ...]) -> None:
    """Many addresses, or a proxy that speaks for them: silent connections make room here too."""

    async def application(scope: Scope, receive: Receive, send: Send) -> None:
        await PlainTextResponse("here")(scope, receive, send)

    bounds = Bounds(patience=60.0, per_address=12 if proxies else 100, total=30, proxies=proxies)
    with served(application, http=bounded(bounds)) as (server, port):
        held = [
            socket.create_connection(("127.0.0.1", port), PATIENCE, (f"127.0.0.{k % 90 + 2}", 0))
            for k in range(200)
        ]
        assert httpx.get(f"http://127.0.0.1:{port}", timeout=PATIENCE).text == "here"
        assert len(server.server_state.connections) <= 30
    for connection in held:
        connection.close()
