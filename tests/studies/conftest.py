"""What tests of studies share: a cluster, which takes seconds to start, and a server."""

from __future__ import annotations

from collections.abc import Iterator

import httpx
import pytest

from stairwright.studies.cluster import ClusterEngine
from stairwright.studies.fill import fill_grid
from stairwright.studies.serial import SerialEngine
from stairwright.studies.store import ResultStore
from stairwright.studies.study import prepared
from stairwright.studies.version import engine_of
from tests.conftest import Server, serve

from .small import LONG


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


@pytest.fixture(scope="session")
def truth(tmp_path_factory: pytest.TempPathFactory) -> ResultStore:
    """What a study of 120 cells gives in one process."""
    made = prepared(LONG)
    path = tmp_path_factory.mktemp("truth") / "t.zarr"
    store = ResultStore.create(path, made, engine_of(made))
    fill_grid(store, SerialEngine(), None, lambda: False)
    return store
