"""Gaps for all wheel samples at once against those of one link after another."""

import numpy as np
import pytest

from stairwright.planning.path.ground import link_clearance, make_ground
from stairwright.planning.path.links import ground_near, nearer

REACH = 0.05


def profile(rng):
    """Stairs, slopes and slits."""
    steps = rng.choice([0.0, 0.003, 0.05, 0.3], 12), rng.uniform(-0.3, 0.3, 12)
    points = np.cumsum(np.stack(steps, axis=1), axis=0)
    ends = [[points[0, 0] - 1.5, points[0, 1]]], [[points[-1, 0] + 1.5, points[-1, 1]]]
    return make_ground(np.concatenate([ends[0], points, ends[1]]))


@pytest.mark.parametrize("seed", range(20))
def test_gaps_are_those_of_one_link_after_another(seed):
    rng = np.random.default_rng(seed)
    ground = profile(rng)
    wheels = np.stack(
        [np.sort(rng.uniform(ground.x[0], ground.x[-1], 40)), rng.uniform(-0.5, 0.8, 40)], axis=1
    )
    near = ground_near(ground, wheels, 0.8)
    buried = 0
    for _ in range(50):
        link = rng.uniform(-0.35, 0.35, 4).astype(np.float32)
        best = np.full(40, REACH**2, np.float32)
        nearer(near, link, REACH, best)
        begin = wheels + link[:2]
        end = begin + link[2:]
        one = [link_clearance(ground, *a, *b, 0.0, REACH) for a, b in zip(begin, end, strict=True)]
        buried += int((best < 0).sum())
        # Where a link all but touches, rounding decides whether it crosses.
        sure = np.abs(one) > 1e-4
        assert ((best < 0) == (np.array(one) < 0))[sure].all()
        both = sure & (best >= 0)
        assert np.sqrt(best[both]) == pytest.approx(np.array(one)[both], abs=2e-6)
    assert 0 < buried < 2000
