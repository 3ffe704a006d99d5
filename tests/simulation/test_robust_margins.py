"""How much delay and how much less friction a plan stands."""

from __future__ import annotations

import pytest

import stairwright as sw
from stairwright.errors import InputError
from stairwright.simulation import robust_margins as module
from stairwright.simulation.robust_margins import robust_margins
from stairwright.simulation.rollout import rollout

STEP = {"name": "step", "points": [[-0.9, 0.0], [0.0, 0.0], [0.0, 0.06], [0.9, 0.06]]}


@pytest.mark.slow
def test_margins_are_where_rollouts_begin_to_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "DELAYS", (0.004, 0.03))
    monkeypatch.setattr(module, "FRICTIONS", (0.1, 0.3))
    plan = sw.plan(STEP, "a1_wheeled", friction=0.4)
    told: list[float] = []
    found = robust_margins(plan, progress=told.append)
    assert found.delay is not None
    assert found.friction is not None
    assert told[-1] == 1.0
    assert rollout(plan, disturbance={"delay": found.delay}).success
    assert rollout(plan, disturbance={"friction": -found.friction}).success
    assert bool(found.delay_ends) == (found.delay < 0.03)


def test_a_seed_is_a_whole_number() -> None:
    plan = sw.plan(STEP, "a1_wheeled", friction=0.4)
    with pytest.raises(InputError):
        robust_margins(plan, seed=-1)
