"""Twenty stairs: small errors of each must not add up."""

from __future__ import annotations

import numpy as np
import pytest

import stairwright as sw
from stairwright.control.settings import parse_settings
from stairwright.simulation.disturbance import Disturbance
from stairwright.simulation.run import Run
from stairwright.terrain.stairs import stair

ATTITUDE, PLACE = 2, slice(7, 9)  # of what is judged: pitch [rad], x and z [m]


@pytest.mark.slow
def test_noise_neither_tips_the_attitude_nor_moves_the_place() -> None:
    flight = stair(0.17, 0.29, 20, direction="down", approach=1.2, platform=1.2)
    plan = sw.plan(flight, "b2w", 0.6)
    run = Run(plan, 0.6, parse_settings({"sensing": "robot"}), Disturbance(), 1, 20.0)
    result = run.result(run.simulate(None), keep_plan=False)
    assert result.outcome == "success", result.reason
    assert run.native is not None
    errors = np.asarray(run.native.judged)
    assert np.abs(errors[:, ATTITUDE]).max() < 0.008
    assert np.linalg.norm(errors[:, PLACE], axis=1).max() < 0.02
