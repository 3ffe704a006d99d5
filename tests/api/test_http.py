"""What holds for every route: headers, HEAD, known parameters, whom it believes."""

from __future__ import annotations

import httpx
import pytest

from stairwright.api.attempts import Attempts
from stairwright.api.settings import Settings
from stairwright.errors import InputError
from tests.conftest import Server


def test_every_answer_has_the_usual_headers(server: Server) -> None:
    session = httpx.post(f"{server.url}/api/v1/sessions").json()["id"]
    for path, frames in (
        ("/", "'self'"),
        ("/docs.html", "'self'"),
        (f"/scene/{session}/", "'self'"),
        ("/api/v1/terrains", "'none'"),
        ("/api/v1/nothing", "'none'"),
        ("/metrics", "'none'"),
        ("/healthz", "'none'"),
    ):
        headers = httpx.get(server.url + path).headers
        assert f"frame-ancestors {frames}" in headers["content-security-policy"], path
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["referrer-policy"] in ("same-origin", "no-referrer")
        assert headers["cross-origin-opener-policy"] == "same-origin"
        assert headers["cross-origin-resource-policy"] == "same-origin"
        assert "camera=()" in headers["permissions-policy"]
    refused = httpx.get(server.url, headers={"host": "evil.example"})
    assert refused.headers["x-content-type-options"] == "nosniff"
    httpx.delete(f"{server.url}/api/v1/sessions/{session}")


def test_head_is_get_without_a_body(server: Server, api: httpx.Client) -> None:
    plan = api.post("/plans", json={"terrain": "flat", "method": "critical"}).json()["id"]
    for path in ("/terrains", "/terrains/flat", "/healthz", f"/plans/{plan}", "/openapi.json",
                 f"/plans/{plan}/export?format=csv"):  # fmt: skip
        got, head = api.get(path), api.head(path)
        assert head.status_code == got.status_code == 200, path
        assert head.content == b""
        assert head.headers.get("content-length") == got.headers.get("content-length")
        assert head.headers.get("etag") == got.headers.get("etag")
    tag = api.head("/terrains").headers["etag"]
    assert api.head("/terrains", headers={"if-none-match": tag}).status_code == 304
    assert api.head("/terrains/none").status_code == 404
    assert httpx.head(f"{server.url}/metrics").status_code == 200
    assert api.head("/plans/live").status_code == 404


def test_head_does_not_wait_for_a_stream(api: httpx.Client) -> None:
    job = api.post("/rollouts", json={"terrain": "three-stairs-up", "seed": 11}).json()
    head = api.head(f"/jobs/{job['id']}/events")
    assert head.status_code == 200
    assert head.headers["content-type"].startswith("text/event-stream")
    api.delete(f"/jobs/{job['id']}")
    assert api.get("/healthz").status_code == 200


@pytest.mark.parametrize(
    ("path", "named", "known"),
    [
        ("/terrains?limits=5", ["limits"], "limit, offset"),
        ("/terrains?limit=5&x=1&y=2", ["x", "y"], "limit, offset"),
        ("/plans?page=2", ["page"], "limit"),
        ("/plans/p-0/export?fromat=csv", ["fromat"], "format"),
        ("/jobs/j-0/events?serie=false", ["serie"], "series"),
        ("/healthz?verbose", ["verbose"], "none here"),
        ("/healthz?verbose=1", ["verbose"], "none here"),
        ("/robots?%00=1", ["\N{REPLACEMENT CHARACTER}"], "there"),
        ("/terrains?token=guess", ["token"], "limit, offset"),
    ],
)
def test_unknown_parameters_are_named(
    api: httpx.Client, path: str, named: list[str], known: str
) -> None:
    answer = api.get(path)
    assert answer.status_code == 422
    problem = answer.json()
    assert [error["field"] for error in problem["errors"]] == named
    assert known in problem["detail"]
    assert api.head(path).status_code == 422


def test_unknown_parameters_are_refused_before_anything_is_done(api: httpx.Client) -> None:
    body = {"terrain": "flat", "method": "critical", "seed": 77}
    before = api.get("/rollouts").headers["x-total-count"]
    assert api.post("/rollouts?priority=1", json=body).status_code == 422
    assert api.put("/terrains/x?force=1", json={"points": [[0, 0], [1, 0]]}).status_code == 422
    assert api.get("/terrains/x").status_code == 404
    assert api.get("/rollouts").headers["x-total-count"] == before


def test_attempts_are_forgotten_after_a_minute() -> None:
    now = 0.0
    attempts = Attempts(2, clock=lambda: now)
    attempts.add_wrong("192.0.2.1", "a")
    now = 10.0
    attempts.add_wrong("192.0.2.1", "b")
    assert attempts.wait("192.0.2.1") == 50.0
    assert attempts.wait("192.0.2.2") == 0.0
    now = 61.0
    assert attempts.wait("192.0.2.1") == 0.0
    for k in range(3):  # a network of IPv6 is one customer
        attempts.add_wrong(f"2001:db8::{k}", str(k))
    assert attempts.wait("2001:db8::ff") > 0.0
    assert attempts.wait("2001:db8:0:1::") == 0.0
    for k in range(10_000):
        attempts.add_wrong(f"10.0.{k // 256}.{k % 256}", "a")
    assert len(attempts._wrong) <= 4096


@pytest.mark.parametrize("proxies", ["proxy.example", "10.0.0.7/24", "10.0.0.0/33"])
def test_proxies_that_are_none_are_refused_at_the_start(proxies: str) -> None:
    with pytest.raises(InputError, match="STAIRWRIGHT_PROXIES"):
        Settings(proxies=proxies)
