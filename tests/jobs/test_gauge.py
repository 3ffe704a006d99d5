"""Progress one way, the wish to cancel the other way."""

from __future__ import annotations

from pathlib import Path

import pytest

from stairwright.errors import Cancelled
from stairwright.jobs.gauge import Gauge


def test_both_sides_see_the_same() -> None:
    ours = Gauge.create()
    theirs = Gauge(ours.path)
    assert ours.progress == 0.0
    theirs.report(0.25)
    assert ours.progress == 0.25
    theirs.report(7.0)
    assert ours.progress == 1.0
    ours.cancel()
    with pytest.raises(Cancelled):
        theirs.report(0.5)


def test_its_file_goes_with_it() -> None:
    gauge = Gauge.create()
    path = Path(gauge.path)
    assert path.exists()
    del gauge
    assert not path.exists()
