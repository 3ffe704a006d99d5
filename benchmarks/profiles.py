"""Random terrain profiles: stairs, ramps, curbs, ditches and drawn polylines, by seed."""

from __future__ import annotations

import math

import numpy as np

from stairwright.terrain.profile import Terrain

FLAT = 1.3  # m before and after the obstacle
KINDS = ("stair", "stairs", "up and down", "down", "ramp", "curb", "ditch", "drawn", "mixed")


def _climb(x: float, z: float, rise: float, face: float) -> tuple[float, float]:
    """End of a face of `rise` m (negative: down) inclined by `face` degrees (90: vertical)."""
    run = 0.0 if face >= 89.5 else abs(rise) / math.tan(math.radians(face))
    return x + run, z + rise


def _flight(p: list[tuple[float, float]], n: int, rise: float, run: float, face: float) -> None:
    for k in range(n):
        p.append(_climb(*p[-1], rise, face))
        if k + 1 < n:
            p.append((p[-1][0] + run, p[-1][1]))


def _drawn(rng: np.random.Generator, p: list[tuple[float, float]]) -> None:
    """A polyline as somebody draws it: faces and treads of any slope, in turn."""
    for _ in range(int(rng.integers(2, 6))):
        steep = 90.0 if rng.random() < 0.4 else rng.uniform(15.0, 90.0)
        tall = 0.42 if rng.random() < 0.25 else 0.2
        sign = 1.0 if rng.random() < (0.65 if p[-1][1] > -0.2 else 0.9) else -1.0
        p.append(_climb(*p[-1], sign * rng.uniform(0.02, tall), steep))
        length = rng.uniform(0.06, 0.6)
        slope = 0.0 if rng.random() < 0.55 else math.radians(rng.uniform(-15.0, 15.0))
        p.append((p[-1][0] + length, p[-1][1] + length * math.tan(slope)))


def _noise(rng: np.random.Generator, p: list[tuple[float, float]]) -> None:
    """Rough ground: short pieces of small random slope."""
    for _ in range(int(rng.integers(4, 12))):
        length = rng.uniform(0.04, 0.25)
        p.append((p[-1][0] + length, p[-1][1] + length * math.tan(rng.uniform(-0.35, 0.35))))


def random_profile(seed: int) -> tuple[str, Terrain]:
    """Kind and terrain number `seed`; the same for the same seed, kinds in turn."""
    rng = np.random.default_rng([20, seed])
    kind = KINDS[seed % len(KINDS)]
    face = 90.0 if rng.random() < 0.6 else rng.uniform(50.0, 90.0)
    p: list[tuple[float, float]] = [(-FLAT, 0.0), (0.0, 0.0)]
    if kind == "stair":
        _flight(p, 1, rng.uniform(0.03, 0.5), 0.3, face)
    elif kind == "stairs":
        _flight(p, int(rng.integers(2, 6)), rng.uniform(0.05, 0.26), rng.uniform(0.22, 0.4), face)
    elif kind == "up and down":
        n, rise, run = int(rng.integers(1, 4)), rng.uniform(0.05, 0.22), rng.uniform(0.24, 0.4)
        _flight(p, n, rise, run, face)
        p.append((p[-1][0] + rng.uniform(0.25, 1.2), p[-1][1]))
        _flight(p, n, -rise, run, face)
    elif kind == "down":
        n, rise = int(rng.integers(1, 4)), rng.uniform(0.05, 0.25)
        _flight(p, n, -rise, rng.uniform(0.25, 0.4), face)
    elif kind == "ramp":
        rise = rng.uniform(0.1, 0.5) * (1 if rng.random() < 0.6 else -1)
        p.append(_climb(*p[-1], rise, rng.uniform(8.0, 45.0)))
    elif kind == "curb":
        rise, width = rng.uniform(0.01, 0.25), rng.uniform(0.05, 0.8)
        p.append(_climb(*p[-1], rise, face))
        p.append((p[-1][0] + width, p[-1][1]))
        p.append(_climb(*p[-1], -rise, face))
    elif kind == "ditch":
        depth, width = rng.uniform(0.03, 0.3), rng.uniform(0.03, 0.7)
        p.append(_climb(*p[-1], -depth, face))
        p.append((p[-1][0] + width, p[-1][1]))
        p.append(_climb(*p[-1], depth * rng.uniform(0.5, 1.2), face))
    elif kind == "drawn":
        _drawn(rng, p)
    else:
        _noise(rng, p)
        _drawn(rng, p)
    p.append((p[-1][0] + FLAT, p[-1][1]))
    name = f"{kind} {seed}"
    return kind, Terrain.model_validate({"name": name, "points": p})
