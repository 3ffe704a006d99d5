"""Settings, and what an operator needs."""

from __future__ import annotations

import json
from pathlib import Path

import httpx
import pytest

from stairwright.api.origins import same_site
from stairwright.api.settings import Settings
from stairwright.errors import InputError
from tests.conftest import Server


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
