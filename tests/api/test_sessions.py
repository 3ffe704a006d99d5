"""3D scenes: two users never see each other, and only the service's own pages get in."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator

import httpx
import pytest
import websockets
from websockets.asyncio.client import connect

from tests.conftest import Server

# What viser's client offers: its version and the protocol are checked by the server.
ORIGIN_REFUSED = 403


@pytest.fixture
def session(api: httpx.Client) -> Iterator[str]:
    made = api.post("/sessions")
    assert made.status_code == 201, made.text
    assert made.json()["scene"] == f"/scene/{made.json()['id']}/"
    yield made.json()["id"]
    api.delete(f"/sessions/{made.json()['id']}")


async def first_message(server: Server, session: str, origin: str | None) -> bytes | str:
    import viser

    address = f"{server.url.replace('http', 'ws')}/scene/{session}/"
    async with connect(
        address,
        origin=origin,  # type: ignore[arg-type]
        subprotocols=[f"viser-v{viser.__version__}"],  # type: ignore[list-item]
        compression=None,
        max_size=None,
    ) as socket:
        return await asyncio.wait_for(socket.recv(), 30)


def test_the_scene_is_served_and_its_socket_handed_on(server: Server, session: str) -> None:
    page = httpx.get(f"{server.url}/scene/{session}/")
    assert page.status_code == 200
    assert "<html" in page.text.lower()
    assert asyncio.run(first_message(server, session, server.url))
    redirected = httpx.get(f"{server.url}/scene/{session}")
    assert redirected.status_code == 307
    assert redirected.headers["location"] == f"/scene/{session}/"


def test_a_foreign_page_gets_no_socket(server: Server, session: str) -> None:
    with pytest.raises(websockets.InvalidStatus) as refused:
        asyncio.run(first_message(server, session, "https://evil.example"))
    assert refused.value.response.status_code == ORIGIN_REFUSED


def test_an_unknown_session_has_no_scene(server: Server) -> None:
    assert httpx.get(f"{server.url}/scene/guess/").status_code == 404
    with pytest.raises(websockets.InvalidStatus):
        asyncio.run(first_message(server, "guess", server.url))


def test_it_shows_plans_and_rollouts(api: httpx.Client, session: str) -> None:
    plan = api.post("/plans", json={"terrain": "flat", "method": "critical"}).json()
    put = f"/sessions/{session}"
    for body in (
        {"plan_id": plan["id"], "rollout_id": None, "theme": "light"},
        {"layers": {"ghosts": False, "com": True}},
        {"camera": "side"},
        {"plan_id": None},
        {},
    ):
        answer = api.put(f"{put}/scene", json=body)
        assert answer.status_code == 204, answer.text
    for body in ({"time": 1.0}, {"progress": 0.2}, {"playing": True, "speed": 2}, {}):
        assert api.put(f"{put}/playback", json=body).status_code == 204
    for path, body, status in (
        ("scene", {"plan_id": "p-0123"}, 404),
        ("scene", {"theme": "pink"}, 422),
        ("scene", {"layers": {"dragons": True}}, 422),
        ("playback", {"speed": 0}, 422),
        ("playback", {"time": "soon"}, 422),
    ):
        answer = api.put(f"{put}/{path}", json=body)
        assert answer.status_code == status, answer.text


def test_two_users_do_not_disturb_each_other(server: Server, api: httpx.Client) -> None:
    one, two = (api.post("/sessions").json()["id"] for _ in range(2))
    assert one != two
    plan = api.post("/plans", json={"terrain": "flat", "method": "critical"}).json()
    assert api.put(f"/sessions/{one}/scene", json={"plan_id": plan["id"]}).status_code == 204
    alone = asyncio.run(first_message(server, two, server.url))
    assert plan["id"].encode() not in (alone if isinstance(alone, bytes) else alone.encode())
    assert api.delete(f"/sessions/{one}").status_code == 204
    assert api.delete(f"/sessions/{one}").status_code == 404
    assert httpx.get(f"{server.url}/scene/{one}/").status_code == 404
    assert httpx.get(f"{server.url}/scene/{two}/").status_code == 200
    assert asyncio.run(first_message(server, two, server.url))
    api.delete(f"/sessions/{two}")


def test_the_scenes_own_port_is_not_told(api: httpx.Client, session: str) -> None:
    made = api.post("/sessions", headers={"idempotency-key": f"k-{session}"})
    again = api.post("/sessions", headers={"idempotency-key": f"k-{session}"})
    assert set(made.json()) == {"id", "scene"}
    assert made.json() == again.json()
    api.delete(f"/sessions/{made.json()['id']}")


def test_a_second_plan_can_be_compared(api: httpx.Client, session: str) -> None:
    question = {"terrain": {"points": [[-1, 0], [0, 0], [0, 0.05], [1, 0.05]]}}
    ids = [api.post("/plans", json={**question, "method": method}).json()["id"]
           for method in ("critical", "nominal")]  # fmt: skip
    scene = f"/sessions/{session}/scene"
    body = {"plan_id": ids[0], "compare_plan_id": ids[1]}
    assert api.put(scene, json=body).status_code == 204
    assert api.put(scene, json={"compare_plan_id": None}).status_code == 204
    assert api.put(scene, json={"compare_plan_id": "p-00"}).status_code == 404
