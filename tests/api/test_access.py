"""The token, the page, and what an operator needs."""

from __future__ import annotations

import asyncio
import contextlib
import json
from collections.abc import Callable
from pathlib import Path

import httpx
import pytest
import websockets
from websockets.asyncio.client import connect

from stairwright.api.origins import same_site
from stairwright.api.settings import Settings
from stairwright.errors import InputError
from tests.conftest import Server

Start = Callable[..., contextlib.AbstractContextManager[Server]]
TOKEN = "correct-horse-battery"


@pytest.mark.slow
def test_with_a_token_nothing_is_open_without_it(start_server: Start, tmp_path: Path) -> None:
    page = tmp_path / "page"
    (page / "assets").mkdir(parents=True)
    (page / "index.html").write_text("<html>the page</html>")
    (page / "assets" / "main-1.js").write_text("1")
    with start_server(STAIRWRIGHT_TOKEN=TOKEN, STAIRWRIGHT_PAGE=str(page)) as server:
        for path in ("/", "/api/v1/terrains", "/api/v1/openapi.json", "/metrics", "/scene/x/"):
            closed = httpx.get(server.url + path)
            assert closed.status_code == 401, path
            assert closed.headers["www-authenticate"].startswith("Bearer")
            wrong = {"authorization": "Bearer wrong"}
            assert httpx.get(server.url + path, headers=wrong).status_code == 401
        assert httpx.get(f"{server.url}/healthz").status_code == 200
        bearer = {"authorization": f"Bearer {TOKEN}"}
        assert httpx.get(f"{server.url}/api/v1/terrains", headers=bearer).status_code == 200
        with httpx.Client(base_url=server.url, follow_redirects=True, timeout=60) as browser:
            assert browser.get("/", params={"token": "wrong"}).status_code == 401
            opened = browser.get("/", params={"token": TOKEN, "t": "x y"})
            assert opened.text == "<html>the page</html>"
            assert TOKEN not in str(opened.url)
            assert opened.url.params["t"] == "x y"
            assert TOKEN not in str(dict(browser.cookies))
            assert browser.get("/api/v1/terrains").status_code == 200
            asset = browser.get("/assets/main-1.js")
            assert "immutable" in asset.headers["cache-control"]
            assert browser.get("/assets/none.js").status_code == 404
            session = browser.post("/api/v1/sessions").json()["scene"]

            async def watch(headers: dict[str, str]) -> None:
                address = server.url.replace("http", "ws") + session
                async with connect(address, additional_headers=headers):
                    pass

            with pytest.raises(websockets.InvalidStatus):
                asyncio.run(watch({}))
            asyncio.run(watch(bearer))
        away = httpx.get(f"{server.url}//evil.example/?token={TOKEN}")
        assert not away.headers.get("location", "/").startswith("//")


def test_metrics_and_request_ids(server: Server) -> None:
    answer = httpx.get(f"{server.url}/api/v1/terrains/flat", headers={"x-request-id": "mine-1"})
    assert answer.headers["x-request-id"] == "mine-1"
    assert httpx.get(f"{server.url}/healthz").headers["x-request-id"]
    text = httpx.get(f"{server.url}/metrics").text
    assert "stairwright_requests_total{" in text
    assert 'route="/api/v1/terrains/{name}"' in text
    assert "stairwright_rollouts_waiting 0.0" in text
    # Structured: one JSON object a line (a line that is being written just now may be cut).
    lines = [json.loads(line) for line in server.log.read_text().splitlines()[:-1]]
    mine = [line for line in lines if line.get("request") == "mine-1"]
    assert mine[-1]["message"] == "GET /api/v1/terrains/flat 200"


@pytest.mark.slow
def test_without_a_page_it_says_so(start_server: Start, tmp_path: Path) -> None:
    with start_server(STAIRWRIGHT_PAGE=str(tmp_path / "none")) as server:
        answer = httpx.get(server.url)
        assert answer.status_code == 503
        assert answer.text.startswith("The page is not built.")


def test_settings_come_from_the_environment() -> None:
    settings = Settings.from_env({"STAIRWRIGHT_PORT": "1234", "STAIRWRIGHT_DATA": "/d"}, host=None)
    assert (settings.port, settings.data, settings.host) == (1234, Path("/d"), "127.0.0.1")
    assert Settings.from_env({"STAIRWRIGHT_PORT": "1"}, port=2).port == 2


@pytest.mark.parametrize(
    ("environ", "words"),
    [
        ({"STAIRWRIGHT_PORT": "many"}, "whole number"),
        ({"STAIRWRIGHT_QUEUE_LIMIT": "-1"}, "at least 0"),
        ({"STAIRWRIGHT_SESSION_IDLE": "nan"}, "at least 1"),
        ({"STAIRWRIGHT_HOST": "0.0.0.0"}, "STAIRWRIGHT_TOKEN"),
        ({"STAIRWRIGHT_TOKEN": "short"}, "at least 8"),
        ({"STAIRWRIGHT_LOG_LEVEL": "loud"}, "debug"),
    ],
)
def test_bad_settings_are_named(environ: dict[str, str], words: str) -> None:
    with pytest.raises(InputError, match=words):
        Settings.from_env(environ)


@pytest.mark.parametrize(
    ("origin", "host", "allowed"),
    [
        ("http://localhost:8000", "localhost:8000", True),
        ("https://stairs.example", "stairs.example", True),
        ("http://localhost:5173", "127.0.0.1:8000", True),
        ("https://friend.example", "localhost:8000", True),
        ("https://evil.example", "localhost:8000", False),
        ("http://localhost:5173", "stairs.example", False),
        ("http://localhost.evil.example", "localhost:8000", False),
        ("null", "localhost:8000", False),
        ("http://[::1", "localhost:8000", False),
        ("https://evil.example", None, False),
    ],
)
def test_origins(origin: str, host: str | None, allowed: bool) -> None:
    assert same_site(origin, host, {"https://friend.example"}) is allowed
