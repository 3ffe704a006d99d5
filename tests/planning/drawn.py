"""Random profiles like those that people draw."""

from __future__ import annotations

import numpy as np

from stairwright.terrain.profile import Terrain


def random_profile(seed: int) -> Terrain:
    """Steps, slopes and flats of moderate size between two level ends."""
    random = np.random.default_rng(seed)
    x, z = 0.0, 0.0
    points = [(-1.0, 0.0), (0.0, 0.0)]
    for _ in range(random.integers(1, 6)):
        if random.random() < 0.5:
            z += random.choice([-1, 1]) * random.uniform(0.03, 0.25)
            points.append((x, z))
        length, slope = random.uniform(0.15, 0.5), random.uniform(-0.4, 0.4)
        x, z = x + length, z + length * np.tan(slope)
        points.append((x, z))
    points.append((x + 1.2, z))
    return Terrain(name=f"drawn-{seed}", points=points)
