"""What tests of studies share: a cluster, which takes seconds to start, and a server."""

from __future__ import annotations

from collections.abc import Iterator

import httpx
import pytest

from stairwright.studies.cluster import ClusterEngine
from tests.conftest import Server, serve


@pytest.fixture(scope="session")
def cluster() -> Iterator[ClusterEngine]:
    """An engine over two workers."""
    engine = ClusterEngine(None, 2)
    yield engine
    engine.close()


@pytest.fixture(scope="session")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A server for studies alone, with one process for them: it needs no cluster."""
    variables = {"STAIRWRIGHT_STUDY_WORKERS": "1", "STAIRWRIGHT_STUDY_CELLS": "2000"}
    with serve(tmp_path_factory.mktemp("studies") / "data", **variables) as running:
        yield running


@pytest.fixture(scope="module")
def api(service: Server) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=f"{service.url}/api/v1", timeout=60) as client:
        yield client
