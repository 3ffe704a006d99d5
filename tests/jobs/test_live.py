"""The series of a running rollout: in pieces, each sample once, as the result says in the end."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from stairwright.jobs.live import NAMES, STRIDE, Broadcast, LiveSeries, append
from stairwright.planning.planner import plan
from stairwright.simulation.rollout import rollout


def test_pieces_make_up_the_series() -> None:
    course = plan({"points": [[-0.5, 0.0], [1.0, 0.0]]}, method="nominal")
    shown = LiveSeries()
    run = rollout(course, observe=Broadcast(partial(append, shown.path), 0.001))  # many pieces
    chunks: list[dict[str, Any]] = []
    offset = 0
    for _ in range(2):  # the second look finds nothing new
        lines, offset = shown.after(offset)
        chunks += [json.loads(line) for line in lines]
    assert len(chunks) > 3
    assert set(chunks[0]) == {"from", *NAMES}
    count = 0
    for chunk in chunks:
        assert chunk["from"] == count
        count += len(chunk["time"])
    for name in NAMES:
        told = np.concatenate([np.array(chunk[name]) for chunk in chunks])
        meant = np.array(getattr(run.series, name))[::STRIDE][:count]
        np.testing.assert_allclose(told, meant, atol=6e-6)
    assert count > 0.8 * len(run.series.time) / STRIDE


def test_a_line_that_is_being_written_is_read_later() -> None:
    shown = LiveSeries()
    with open(shown.path, "ab") as file:  # noqa: PTH123
        file.write(b'{"a": 1}\n{"b"')
        file.flush()
        lines, offset = shown.after(0)
        assert lines == [b'{"a": 1}']
        file.write(b": 2}\n")
        file.flush()
        assert shown.after(offset)[0] == [b'{"b": 2}']
    path = Path(shown.path)
    del shown
    assert not path.exists()
