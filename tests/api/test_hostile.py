"""Whatever a client can send is answered with a problem document, never with a 500."""

from __future__ import annotations

import json
import socket
import struct
from collections.abc import Iterator
from urllib.parse import urlsplit

import httpx
import pytest

from tests.conftest import Server

JSON = {"content-type": "application/json"}
FLAT = '{"points": [[0, 0], [1, 0]]}'


def refused(answer: httpx.Response, *statuses: int) -> dict[str, object]:
    assert answer.status_code in statuses, answer.text[:500]
    assert answer.headers["content-type"] == "application/problem+json"
    problem = answer.json()
    assert problem["status"] == answer.status_code
    assert problem["detail"]
    assert len(answer.content) < 20_000
    return dict(problem)


@pytest.mark.parametrize(
    "body",
    [
        '{"terrain": {"points": [[0, 0], [1, NaN]]}}',
        '{"terrain": {"points": [[0, 0], [1, Infinity]]}}',
        '{"terrain": {"points": [[0, 0], [1e999, 0]]}}',
        f'{{"terrain": {FLAT}, "friction": -Infinity}}',
        f'{{"terrain": {FLAT}, "friction": 1e999}}',
        f'{{"terrain": {FLAT}, "friction": {"9" * 5000}}}',
        f'{{"terrain": {FLAT}, "weights": {{"speed": NaN}}}}',
        '{"terrain": "\\ud800"}',
        '{"terrain": "\\u0000"}',
        '{"\\ud800": 1, "terrain": "flat"}',
        '{"terrain": {"name": "\\udfff", "points": [[0, 0], [1, 0]]}}',
        f'{{"terrain": {FLAT}, "weights": {{"\\udc00": 1}}}}',
        '{"terrain": {"points": ' + "[" * 50_000 + "]" * 50_000 + "}}",
        "[" * 100_000,
        '{"a":' * 30_000 + "1" + "}" * 30_000,
        '{"terrain": {"points": [' + "[0,0]," * 40_000 + "[1,0]]}}",
        '{"terrain": {"points": [' + '"x",' * 50_000 + "0]}}",
        '{"terrain": {' + ",".join(f'"k{i}": 0' for i in range(20_000)) + "}}",
        '{"terrain": {"points": [[0, 0], [1e-320, 0]]}}',
        "",
        "null",
        "[]",
        "1",
        '"flat"',
        "{",
        "\x00",
        "\ufeff{}",
    ],
)
@pytest.mark.parametrize("path", ["/plans", "/rollouts"])
def test_bad_json(api: httpx.Client, path: str, body: str) -> None:
    refused(api.post(path, content=body.encode("utf-8", "surrogatepass"), headers=JSON), 400, 422)


@pytest.mark.parametrize("content", [b"\xff\xfe", b'{"terrain": "\xff"}', b"\x1f\x8b\x08\x00"])
def test_bytes_that_are_no_text(api: httpx.Client, content: bytes) -> None:
    refused(api.post("/plans", content=content, headers=JSON), 400, 422)


def test_a_million_points(api: httpx.Client) -> None:
    body = b'{"terrain": {"points": [' + b"[0,0]," * 1_000_000 + b"[1,0]]}}"
    refused(api.post("/plans", content=body, headers=JSON), 413)


def test_a_long_body_that_does_not_say_how_long(api: httpx.Client) -> None:
    def endless() -> Iterator[bytes]:
        for _ in range(400):
            yield b" " * 4096

    refused(api.post("/plans", content=endless(), headers=JSON), 413)


@pytest.mark.parametrize("length", ["-1", "abc", "1e3", "99999999999999999999999"])
def test_a_content_length_that_is_none(server: Server, length: str) -> None:
    address = urlsplit(server.url)
    with socket.create_connection((address.hostname or "", address.port or 0), 20) as raw:
        raw.sendall(
            b"POST /api/v1/plans HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n"
            b"Content-Length: " + length.encode() + b"\r\n\r\n{}"
        )
        status = int(raw.recv(4096).split()[1])
    assert 400 <= status < 500


@pytest.mark.parametrize("kind", ["text/plain", "application/xml", "multipart/form-data", "", "x"])
def test_another_content_type(api: httpx.Client, kind: str) -> None:
    for path in ("/plans", "/rollouts", "/terrains/generate"):
        refused(api.post(path, content=b"{}", headers={"content-type": kind}), 415)


@pytest.mark.slow
def test_wrong_methods_and_places(api: httpx.Client) -> None:
    wrong = api.request("PATCH", "/terrains/flat")
    refused(wrong, 405)
    assert wrong.headers["allow"] == "DELETE, GET, HEAD, PUT"
    refused(api.get("/nothing"), 404)
    refused(api.get("/jobs/j-0"), 404)
    refused(api.get("/jobs/j-0/events"), 404)
    refused(api.delete("/jobs/j-0"), 404)
    refused(api.get("/plans/p-0"), 404)
    refused(api.get("/plans/p-0/export"), 404)
    refused(api.get("/rollouts/r-0"), 404)
    refused(api.put("/sessions/none/scene", json={}), 404)
    refused(api.put("/sessions/none/playback", json={}), 404)


@pytest.mark.parametrize(
    "path",
    [
        "/terrains/%00",
        "/terrains/%ff",
        "/terrains/..%2f..%2fetc%2fpasswd",
        "/terrains/" + "a" * 5000,
        "/terrains/%ed%a0%80",
        "/plans/%0a",
        "/jobs/" + "%20" * 50,
        "/terrains?limit=-1",
        "/terrains?limit=NaN",
        "/terrains?offset=99999999999999999999999",
        "/plans?limit=1e9",
        "/plans/p-0/export?format=exe",
    ],
)
def test_bad_addresses(api: httpx.Client, path: str) -> None:
    refused(api.get(path), 404, 422)


@pytest.mark.parametrize(
    "headers",
    [
        {"idempotency-key": "a" * 300},
        {"idempotency-key": "two words"},
        {"accept-encoding": "gzip;q=banana, *;q=, ;;"},
        {"if-none-match": '"' * 999},
        {"x-request-id": "a\x7fb"},
        {"cookie": "=;;=\x01"},
        {"last-event-id": "9" * 10_000},
        {"authorization": "Bearer \x7f"},
    ],
)
def test_odd_headers(api: httpx.Client, headers: dict[str, str]) -> None:
    for answer in (
        api.get("/terrains", headers=headers),
        api.get("/jobs/j-1/events", headers=headers),
        api.post("/rollouts", json={}, headers=headers),
    ):
        assert answer.status_code < 500


@pytest.mark.slow
def test_mesh_bombs(api: httpx.Client) -> None:
    many = b"\0" * 80 + struct.pack("<I", 10_000_000) + b"\0" * 5000  # says 10^7, holds 100
    answer = api.post("/terrains/import", files={"file": ("a.stl", many)})
    refused(answer, 422)
    faces = b"v 0 0 0\nv 1 0 0\nv 0 1 0\n" + b"f 1 2 3\n" * 600_000
    refused(api.post("/terrains/import", files={"file": ("a.obj", faces)}), 422)
    refused(api.post("/terrains/import", files={"file": ("a.yaml", b"[" * 200_000)}), 422)
    laughs = "\n".join(f"a{k}: &a{k} [*a{k - 1}, *a{k - 1}]" for k in range(1, 30))
    bomb = f"a0: &a0 [1, 1]\n{laughs}\n".encode()
    refused(api.post("/terrains/import", files={"file": ("a.yaml", bomb)}), 422)
    refused(api.post("/terrains/import", data={"name": "x"}), 422)
    refused(api.post("/terrains/import", content=b"--x", headers={
        "content-type": "multipart/form-data; boundary=x"}), 400, 422)  # fmt: skip
    refused(api.post("/terrains/import", files={"file": ("a.stl", b"x" * (33 * 2**20))}), 413)


def test_a_plan_document_from_outside_is_checked(api: httpx.Client) -> None:
    plan = api.post("/plans", json={"terrain": json.loads(FLAT), "method": "critical"}).json()
    plan["poses"] = plan["poses"][:1]
    for path in (("poses", 0, "q"), ("poses", 0, "x_c"), ("robot_description",), ("timing",)):
        broken = json.loads(json.dumps(plan))
        where = broken
        for key in path[:-1]:
            where = where[key] if not isinstance(where, list) or where else {}
        if isinstance(where, dict):
            where[path[-1]] = "hello"
            refused(api.post("/rollouts", json={"plan": broken}), 422)


def test_another_page_may_not_act_for_the_user(server: Server) -> None:
    body = {"terrain": "flat"}
    evil = {"origin": "https://evil.example"}
    answer = httpx.post(f"{server.url}/api/v1/rollouts", json=body, headers=evil)
    refused(answer, 403)
    local = {"origin": "http://localhost:5173"}
    assert httpx.delete(f"{server.url}/api/v1/jobs/j-0", headers=local).status_code == 404


def test_after_all_this_it_still_serves(api: httpx.Client) -> None:
    assert api.get("/healthz").json()["status"] == "ok"
    assert api.post("/plans", json={"terrain": "flat", "method": "critical"}).status_code == 200
