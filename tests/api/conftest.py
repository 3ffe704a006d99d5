"""A client of the running service."""

from __future__ import annotations

from collections.abc import Iterator

import httpx
import pytest

from tests.conftest import Server


@pytest.fixture(scope="module")
def api(server: Server) -> Iterator[httpx.Client]:
    """Paths count from `/api/v1`."""
    with httpx.Client(base_url=f"{server.url}/api/v1", timeout=120) as client:
        yield client
