"""One error, one line in the log, with the id of the request that it belongs to."""

from __future__ import annotations

import contextlib
import json
import os
import sqlite3
import subprocess
import time
from collections.abc import Iterator
from typing import Any

import httpx
import pytest

from tests.conftest import Server, serve

pytestmark = pytest.mark.slow  # a server of its own

STAIR = {"points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}


# Root obeys permissions too without these.
MORTAL = ("setpriv", "--bounding-set=-dac_override,-dac_read_search")


@pytest.fixture(scope="module")
def mortal(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A server that obeys permissions, whoever runs the tests."""
    data = tmp_path_factory.mktemp("mortal") / "data"
    with serve(data, MORTAL if os.geteuid() == 0 else ()) as server:
        yield server


def lines(server: Server, containing: str) -> list[dict[str, Any]]:
    """Of the log."""
    told = [json.loads(line) for line in server.log.read_text().splitlines()]
    return [line for line in told if containing in line["message"]]


def test_an_unexpected_error_is_logged_once(mortal: Server) -> None:
    with httpx.Client(base_url=f"{mortal.url}/api/v1", timeout=60) as api:
        api.put("/terrains/spoilt", json=STAIR)
        with contextlib.closing(sqlite3.connect(mortal.data / "stairwright.sqlite")) as other:
            other.execute("UPDATE terrains SET document = '[]'")
            other.commit()
        answer = api.get("/terrains/spoilt", headers={"x-request-id": "mine"})
    assert answer.status_code == 500
    assert answer.headers["content-type"] == "application/problem+json"
    assert "bug" in answer.json()["detail"]
    assert "content-security-policy" in answer.headers
    told = [line for line in lines(mortal, "") if line["level"] == "error"]
    errors = [line for line in told if "compress" not in line["message"]]  # those are below
    assert len(errors) == 1, [error["message"] for error in errors]
    assert errors[0]["request"] == "mine"
    assert "Traceback" in errors[0]["exception"]


def test_what_fails_again_and_again_is_told_once(mortal: Server) -> None:
    artefacts = mortal.data / "artefacts"

    def permit(mode: str) -> None:
        subprocess.run(["chmod", "-R", mode, str(artefacts)], check=True)

    def errors() -> list[dict[str, Any]]:
        return [line for line in lines(mortal, "compress") if line["level"] == "error"]

    def recoveries() -> list[dict[str, Any]]:
        return lines(mortal, "compressing new results works again")

    for friction in range(20):  # until a result is caught before it is compressed
        body = {"terrain": STAIR, "friction": 0.5 + friction * 0.01}
        httpx.post(f"{mortal.url}/api/v1/plans", json=body, timeout=60)
        failed, mended = len(errors()), len(recoveries())  # by earlier rounds
        permit("a-w")
        if list(artefacts.glob("??/*.json")):
            break
        permit("u+w")
    time.sleep(5.0)  # it is tried every 2 s
    permit("u+w")
    give_up = time.monotonic() + 30
    while len(recoveries()) == mended:
        assert time.monotonic() < give_up
        time.sleep(0.2)
    assert len(errors()) - failed == 1
