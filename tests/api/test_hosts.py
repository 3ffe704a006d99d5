"""The service answers to its own names only: a name that is made to lead here gets nothing."""

from __future__ import annotations

import asyncio
import socket
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

import httpx
import pytest
import websockets
from starlette.responses import PlainTextResponse
from starlette.types import Receive, Scope, Send
from websockets.asyncio.client import connect

from stairwright.api.hosts import Hosts, host_name
from stairwright.api.settings import Settings
from stairwright.errors import InputError
from tests.conftest import CHROMIUM_FLAGS, Server
from tests.in_process import served

if TYPE_CHECKING:
    from playwright.sync_api import Browser


def raw(server: Server, head: str) -> tuple[int, bytes]:
    """Status and answer to a request as it stands."""
    address = urlsplit(server.url)
    with socket.create_connection((address.hostname or "", address.port or 0), 20) as connection:
        connection.sendall(head.replace("\n", "\r\n").encode("latin-1") + b"\r\n")
        answer = b""
        while part := connection.recv(65536):
            answer += part
    return int(answer.split()[1]), answer


@pytest.mark.parametrize(
    ("host", "status"),
    [
        ("localhost", 200),
        ("LOCALHOST:80", 200),
        ("localhost.:8000", 200),
        ("127.0.0.1:1", 200),
        ("[::1]:8000", 200),
        ("evil.example", 421),
        ("evil.example:8000", 421),
        ("localhost.evil.example", 421),
        ("127.0.0.1.evil.example", 421),
        ("localhost@evil.example", 421),
        ("evil.example@localhost", 421),
        ("192.168.1.7", 421),
        ("", 421),
        ("local\xe9", 421),
    ],
)
def test_only_its_own_names(server: Server, host: str, status: int) -> None:
    for path in ("/healthz", "/api/v1/terrains", "/scene/x/", "/"):
        got, answer = raw(server, f"GET {path} HTTP/1.1\nHost: {host}\nConnection: close\n")
        if status == 421:
            assert got == 421
            assert b"application/problem+json" in answer
            assert b"STAIRWRIGHT_HOSTS" in answer
        else:
            assert got != 421


def test_another_page_cannot_write_or_delete_by_rebinding(server: Server) -> None:
    ours = f"{server.url}/api/v1/terrains/mine"
    body = {"points": [[0, 0], [1, 0]]}
    evil = {"host": "evil.example", "origin": "http://evil.example"}
    assert httpx.put(ours, json=body).status_code in (200, 201, 204)
    assert httpx.put(ours, json={"points": [[0, 0], [9, 0]]}, headers=evil).status_code == 421
    assert httpx.delete(ours, headers=evil).status_code == 421
    assert httpx.get(ours).json()["points"] == body["points"]
    assert httpx.delete(ours).status_code == 204


@pytest.mark.parametrize("hosts", [[], ["localhost", "localhost"], ["localhost", "evil.example"]])
def test_exactly_one_host(server: Server, hosts: list[str]) -> None:
    lines = "".join(f"Host: {host}\n" for host in hosts)
    assert raw(server, f"GET /healthz HTTP/1.1\n{lines}Connection: close\n")[0] == 400


def test_websockets_too(server: Server) -> None:
    session = httpx.post(f"{server.url}/api/v1/sessions").json()["id"]
    address = server.url.replace("http", "ws")
    port = urlsplit(server.url).port

    async def status(path: str, name: str) -> int:
        origin, uri = f"http://{name}:{port}", f"ws://{name}:{port}{path}"
        try:
            async with connect(uri, origin=origin, host="127.0.0.1", port=port):  # type: ignore[arg-type]
                return 101
        except websockets.InvalidStatus as refused:
            return refused.response.status_code

    for path in ("/api/v1/plans/live", f"/scene/{session}/", f"/scene/{session}"):
        assert asyncio.run(status(path, "localhost")) == 101, address
        assert asyncio.run(status(path, "evil.example")) == 421
    httpx.delete(f"{server.url}/api/v1/sessions/{session}")


@pytest.mark.parametrize("hosts", ["https://a.example", "a.example:80", "*", "a..b", "-a", "a/b"])
def test_names_that_are_none_are_refused_at_the_start(hosts: str) -> None:
    with pytest.raises(InputError, match="STAIRWRIGHT_HOSTS"):
        Settings(hosts=hosts)


def test_the_address_that_a_request_reaches() -> None:
    async def application(scope: Scope, receive: Receive, send: Send) -> None:
        await PlainTextResponse("here")(scope, receive, send)

    with served(Hosts(application, {"localhost"}), host="0.0.0.0") as (_, port):
        for host, status in (("127.0.0.5", 200), ("127.0.0.6", 421), ("localhost", 200)):
            answer = httpx.get(f"http://127.0.0.5:{port}", headers={"host": f"{host}:{port}"})
            assert answer.status_code == status, host


def test_names_as_they_are_written() -> None:
    settings = Settings(host="192.168.1.7", token="correct-horse", hosts="A.example")
    assert {"192.168.1.7", "a.example", "localhost"} <= settings.allowed_hosts
    assert host_name("[FD00::7]:8000") == "fd00::7"
    assert host_name("two words") is None


@pytest.mark.browser
def test_rebinding_in_a_browser(server: Server, browser: Browser, browser_path: str) -> None:
    """The page comes from the attacker, its requests go to the service under the same name."""
    port = urlsplit(server.url).port
    flags = [
        *CHROMIUM_FLAGS,
        "--host-resolver-rules=MAP evil.example 127.0.0.1",
        "--disable-features=LocalNetworkAccessChecks",  # which not every browser has
    ]
    script = """async () => {
      const read = await fetch("/api/v1/terrains");
      const wrote = await fetch("/api/v1/terrains/stolen", {
        method: "PUT",
        headers: { "content-type": "application/json" },
        body: JSON.stringify({ points: [[0, 0], [1, 0]] }),
      });
      const socket = new WebSocket(`ws://${location.host}/api/v1/plans/live`);
      const opened = await new Promise(done => {
        socket.onopen = () => done(true);
        socket.onerror = () => done(false);
      });
      return [location.hostname, read.status, wrote.status, opened];
    }"""
    page = browser.browser_type.launch(executable_path=browser_path, args=flags).new_page()
    attack = f"http://evil.example:{port}/attack"
    page.route(attack, lambda route: route.fulfill(content_type="text/html", body="<p>"))
    page.goto(attack)
    assert page.evaluate(script) == ["evil.example", 421, 421, False]
    if page.context.browser:
        page.context.browser.close()
    assert httpx.get(f"{server.url}/api/v1/terrains/stolen").status_code == 404
