"""A service with a token, further names, another site and a proxy: who gets in, who is believed.

All of them are set for one server; tests that guess tokens do so from addresses of their own.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import httpx
import pytest
import websockets
from websockets.asyncio.client import connect

from stairwright.api.attempts import WINDOW
from tests.conftest import Server, serve

pytestmark = pytest.mark.slow  # servers of its own

TOKEN = "correct-horse-battery"
BEARER = {"authorization": f"Bearer {TOKEN}"}
FRIEND = "https://friend.example"
GUESSING, OTHER, PROXY = "127.0.0.3", "127.0.0.4", "127.0.0.5"  # addresses of who asks
PREFLIGHT = {
    "access-control-request-method": "PUT",
    "access-control-request-headers": "authorization,content-type,idempotency-key",
}


@pytest.fixture(scope="module")
def guarded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    folder = tmp_path_factory.mktemp("guarded")
    page = folder / "page"
    (page / "assets").mkdir(parents=True)
    (page / "index.html").write_text("<html>the page</html>")
    (page / "assets" / "main-1.js").write_text("1")
    settings = {
        "STAIRWRIGHT_TOKEN": TOKEN,
        "STAIRWRIGHT_TOKEN_ATTEMPTS": "3",
        "STAIRWRIGHT_PAGE": str(page),
        "STAIRWRIGHT_HOSTS": "stairs.example [fd00::7]",
        "STAIRWRIGHT_ORIGINS": f"{FRIEND}/",
        "STAIRWRIGHT_PROXIES": f"{PROXY}/32",
    }
    with serve(folder / "data", **settings) as server:
        yield server


def caller(source: str, headers: dict[str, str] | None = None) -> httpx.Client:
    """Somebody at an address."""
    transport = httpx.HTTPTransport(local_address=source)
    return httpx.Client(transport=transport, headers=headers, timeout=60)


def test_with_a_token_nothing_is_open_without_it(guarded: Server) -> None:
    for path in ("/", "/api/v1/terrains", "/api/v1/openapi.json", "/metrics", "/scene/x/"):
        closed = httpx.get(guarded.url + path)
        assert closed.status_code == 401, path
        assert closed.headers["www-authenticate"].startswith("Bearer")
        wrong = {"authorization": "Bearer wrong"}
        assert httpx.get(guarded.url + path, headers=wrong).status_code == 401
    assert httpx.get(f"{guarded.url}/healthz").status_code == 200
    assert httpx.get(f"{guarded.url}/api/v1/terrains", headers=BEARER).status_code == 200
    with httpx.Client(base_url=guarded.url, follow_redirects=True, timeout=60) as browser:
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
            address = guarded.url.replace("http", "ws") + session
            async with connect(address, additional_headers=headers):
                pass

        with pytest.raises(websockets.InvalidStatus):
            asyncio.run(watch({}))
        asyncio.run(watch(BEARER))
    away = httpx.get(f"{guarded.url}//evil.example/?token={TOKEN}")
    assert not away.headers.get("location", "/").startswith("//")


def test_wrong_tokens_are_limited_by_address(guarded: Server) -> None:
    def ask(source: str, token: str) -> httpx.Response:
        with caller(source, {"authorization": f"Bearer {token}"}) as client:
            return client.get(f"{guarded.url}/api/v1/terrains/flat")

    with caller(GUESSING) as nobody:
        for _ in range(10):  # the same one is no further guess; none at all is no guess
            assert ask(GUESSING, "old-token").status_code == 401
            assert nobody.get(f"{guarded.url}/api/v1/terrains").status_code == 401
        assert ask(GUESSING, TOKEN).status_code == 200
        for guess in ("guess-1", "guess-2"):
            assert ask(GUESSING, guess).status_code == 401
        for token in ("guess-3", TOKEN):
            refused = ask(GUESSING, token)
            assert refused.status_code == 429
            assert 0 < int(refused.headers["retry-after"]) <= WINDOW
        cookie = {"cookie": "stairwright_token=guess"}
        assert nobody.get(guarded.url, headers=cookie).status_code == 429
        assert nobody.get(guarded.url, params={"token": TOKEN}).status_code == 429
        assert nobody.get(f"{guarded.url}/healthz").status_code == 200
    assert ask(OTHER, TOKEN).status_code == 200


def test_further_names_can_be_set(guarded: Server) -> None:
    for host, status in (
        ("stairs.example", 200),
        ("Stairs.Example:443", 200),
        ("[fd00::7]:80", 200),
        ("localhost", 200),
        ("other.example", 421),
    ):
        answer = httpx.get(f"{guarded.url}/healthz", headers={"host": host})
        assert answer.status_code == status, host
    # Its own page, behind a proxy that speaks TLS.
    own = {"host": "stairs.example", "origin": "https://stairs.example", **BEARER}
    assert httpx.delete(f"{guarded.url}/api/v1/jobs/j-0", headers=own).status_code == 404


def test_preflight_needs_no_token_and_strangers_get_nothing(guarded: Server) -> None:
    here = f"{guarded.url}/api/v1/terrains/x"
    answer = httpx.options(here, headers={"origin": FRIEND, **PREFLIGHT})
    assert answer.status_code == 200
    assert answer.headers["access-control-allow-origin"] == FRIEND
    assert "PUT" in answer.headers["access-control-allow-methods"]
    assert "access-control-allow-credentials" not in answer.headers
    network = {"origin": FRIEND, "access-control-request-private-network": "true"}
    allowed = httpx.options(here, headers={**network, **PREFLIGHT})
    assert allowed.headers["access-control-allow-private-network"] == "true"
    for origin in ("https://evil.example", "null", f"{FRIEND}.evil.example", ""):
        refused = httpx.options(here, headers={"origin": origin, **PREFLIGHT})
        read = httpx.get(here, headers={"origin": origin, **BEARER})
        assert refused.status_code == 401
        assert read.status_code == 404
        for each in (refused, read):
            assert not [name for name in each.headers if name.startswith("access-control")]
            assert "Origin" in each.headers["vary"]


def check_belief(server: Server, source: str, believed: bool) -> None:
    """Whether the server takes the word of who asks from `source` for whom it asks."""
    forwarded = {
        "x-forwarded-for": "203.0.113.9",
        "x-forwarded-proto": "https",
        "x-request-id": f"from-{source}",
    }
    with caller(source, forwarded) as client:
        opened = client.get(server.url, params={"token": TOKEN})
    assert ("secure" in opened.headers["set-cookie"].lower()) == believed
    (mine,) = logged(server, f"from-{source}")
    assert mine["client"] == ("203.0.113.9" if believed else source)


def logged(server: Server, request: str) -> list[dict[str, object]]:
    """Lines of the log about a request; they are written after it is answered."""
    end = time.monotonic() + 20.0
    while time.monotonic() < end:
        whole = server.log.read_text().rpartition("\n")[0]
        lines = [json.loads(line) for line in whole.splitlines()]
        if found := [line for line in lines if line.get("request") == request]:
            return found
        time.sleep(0.05)
    return []


@pytest.mark.parametrize(("source", "believed"), [(OTHER, False), (PROXY, True)])
def test_forwarded_addresses_only_from_named_proxies(
    guarded: Server, source: str, believed: bool
) -> None:
    check_belief(guarded, source, believed)


def test_without_a_page_and_proxies_it_says_so_and_believes_nobody(
    start_server: Callable[..., contextlib.AbstractContextManager[Server]], tmp_path: Path
) -> None:
    settings = {"STAIRWRIGHT_TOKEN": TOKEN, "STAIRWRIGHT_PAGE": str(tmp_path / "none")}
    settings["FORWARDED_ALLOW_IPS"] = "*"  # uvicorn's own switch changes nothing
    with start_server(**settings) as server:
        answer = httpx.get(server.url, headers=BEARER)
        assert answer.status_code == 503
        assert answer.text.startswith("The page is not built.")
        check_belief(server, OTHER, believed=False)
