"""One cluster of this machine for all tests of studies: it takes seconds to start."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from stairwright.studies.cluster import ClusterEngine


@pytest.fixture(scope="session")
def cluster() -> Iterator[ClusterEngine]:
    """An engine over four workers."""
    engine = ClusterEngine(None, 4)
    yield engine
    engine.close()
