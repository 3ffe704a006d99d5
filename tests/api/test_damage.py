"""Files that a worn-out disk has damaged: never sent, and made anew when asked for again."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import httpx
import pytest

from tests.conftest import Server

STAIR = {"name": "damaged", "points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}
UNPACKED, PACKED = {"accept-encoding": "identity"}, {"accept-encoding": "gzip"}


def settled(server: Server, etag: str) -> Path:
    """The compressed file behind an entity tag, when it is there."""
    give_up = time.monotonic() + 60
    while True:
        found = list(server.data.glob(f"artefacts/??/{etag.strip(chr(34))}*.json.gz"))
        if found:
            return found[0]
        assert time.monotonic() < give_up
        time.sleep(0.1)


def damage(path: Path, how: str) -> None:
    """As disks do it: a bit in the middle, a page of zeros, an end that is missing."""
    content = bytearray(path.read_bytes())
    if how == "bit":
        content[len(content) // 2] ^= 0x10
    elif how == "zeros":
        content[:] = bytes(len(content))
    else:
        del content[len(content) // 2 :]
    path.write_bytes(content)


def done(api: httpx.Client, body: dict[str, Any]) -> str:
    """The address of a rollout's result."""
    job = api.post("/rollouts", json=body).json()
    give_up = time.monotonic() + 120
    while job["state"] not in ("done", "failed"):
        assert time.monotonic() < give_up
        time.sleep(0.05)
        job = api.get(f"/jobs/{job['id']}").json()
    assert job["state"] == "done", job
    return str(job["result"]).removeprefix("/api/v1")


@pytest.mark.slow
@pytest.mark.parametrize("how", ["bit", "zeros", "short"])
@pytest.mark.parametrize("encoding", [UNPACKED, PACKED], ids=["plain", "gzip"])
def test_a_damaged_plan_is_missing_and_then_made_anew(
    server: Server, how: str, encoding: dict[str, str]
) -> None:
    with httpx.Client(base_url=f"{server.url}/api/v1", timeout=120, headers=encoding) as api:
        question = {"terrain": STAIR, "friction": 0.5}
        answer = api.post("/plans", json=question)
        path, plan = f"/plans/{answer.json()['id']}", answer.json()
        damage(settled(server, answer.headers["etag"]), how)
        missing = api.get(path)
        assert missing.status_code == 404
        assert missing.json()["type"].endswith("not-found")
        assert api.post("/rollouts", json={"plan_id": plan["id"]}).status_code == 404
        again = api.post("/plans", json=question)
        assert again.status_code == 200
        assert again.json()["poses"] == plan["poses"]
        assert api.get(path).json() == again.json()


@pytest.mark.slow
def test_a_damaged_answer_is_not_an_answer(server: Server) -> None:
    with httpx.Client(base_url=f"{server.url}/api/v1", timeout=120) as api:
        plan = {"terrain": STAIR, "friction": 0.55}
        answer = api.post("/plans", json=plan)
        damage(settled(server, answer.headers["etag"]), "bit")
        assert api.post("/plans", json=plan).json()["poses"] == answer.json()["poses"]

        rollout = {"terrain": STAIR, "seed": 3}
        result = done(api, rollout)
        damage(settled(server, api.get(result).headers["etag"]), "bit")
        assert api.get(done(api, rollout)).json()["outcome"] == "success"
