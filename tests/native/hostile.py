"""Terrains and robots that documents allow and nobody builds, and numbers that no sensor gives."""

from __future__ import annotations

from typing import Any

import numpy as np

import stairwright as sw
from stairwright import _core

Points = list[tuple[float, float]]


def saw(corners: int, tooth: float, depth: float) -> Points:
    """As many corners as a profile may have, between two level ends."""
    x = np.arange(corners - 2) * tooth
    z = np.where(np.arange(corners - 2) % 2, depth, 0.0)
    return [(-1.0, 0.0), *zip(x.tolist(), z.tolist(), strict=True), (x[-1] + 1.0, 0.0)]


def terrains() -> dict[str, Points]:
    """Profiles at the edges of what a document may hold."""
    random = np.random.default_rng(5)
    rubble = np.cumsum(random.uniform(0.0, 0.02, 100))
    return {
        "one millimetre": [(0.0, 0.0), (1e-3, 0.0)],
        "shorter than the robot": [(0.0, 0.0), (0.3, 0.0)],
        "far away": [(95.0, 99.9), (97.0, 99.9), (97.0, 100.0), (100.0, 100.0)],
        "cliff of 200 m": [(-1.0, 100.0), (0.0, 100.0), (0.0, -100.0), (1.0, -100.0)],
        "wall of 200 m": [(-1.0, -100.0), (0.0, -100.0), (0.0, 100.0), (1.0, 100.0)],
        "fine saw": saw(2000, 0.001, 0.001),
        "coarse saw": saw(60, 0.05, 0.04),
        "deep saw": saw(400, 0.01, -90.0),
        "spike without width": [(-2, 0), (0, 0), (0, 0.1), (0, 0), (2, 0)],
        "slit": [(-2, 0), (0, 0), (1e-8, -90.0), (2e-8, 0), (2, 0)],
        "least numbers": [(-1.5, 0), (0, 5e-324), (1e-300, -5e-324), (1.5, 1e-310)],
        "rubble": [(-1.5, 0.0), *zip(rubble, random.uniform(0, 0.03, 100), strict=True), (2.5, 0)],
        "pit as wide as a wheel": [(-1, 0), (0, 0), (0, -1), (0.1, -1), (0.1, 0), (1, 0)],
    }


def robot(name: str = "a1_wheeled", **changes: Any) -> dict[str, Any]:
    """A library robot with other numbers, by dotted names with `__`."""
    document = sw.load_robot(name).model_dump()
    for path, value in changes.items():
        *parts, last = path.split("__")
        place = document
        for part in parts:
            place = place[part]
        place[last] = value
    return document


def _scaled(size: float) -> dict[str, Any]:
    base = sw.load_robot("a1_wheeled")
    x, mass = base.hips.front[0] * size, {"mass": 1.0, "inertia": (1.0, 1.0, 1.0)}
    link = {"length": 0.2 * size, "radius": 0.01 * size, "com": 0.5, **mass}
    return robot(
        nominal_height=0.33 * size,
        trunk={"size": [v * size for v in base.trunk.size], **mass},
        hips={"front": (x, 0.0), "rear": (-x, 0.0), "half_track": 0.15 * size},
        thigh=link,
        calf=link,
        wheel={"radius": 0.05 * size, "width": 0.03 * size, **mass},
    )


def robots() -> dict[str, dict[str, Any]]:
    """Robots at the edges of what a document may hold."""
    full = (-2 * np.pi, 2 * np.pi)
    narrow = {"thigh": (0.7, 0.7 + 1e-12), "calf": (-1.4, -1.4 + 1e-12)}
    return {
        "of 3 mm": _scaled(0.01),
        "of 400 m": _scaled(1000.0),
        "flat trunk": robot(trunk__size=(1e-6, 1e-6, 1e-6)),
        "wheels larger than itself": robot(wheel__radius=0.2, nominal_height=0.5),
        "tiny wheels": robot(wheel__radius=1e-9),
        "thick links": robot(thigh__radius=1000.0),
        "no joint range": robot(joints={"front": narrow, "rear": narrow}),
        "any thigh": robot(joints__front__thigh=full, joints__rear__thigh=full),
        "knees opposed": robot(joints__rear__calf=(0.9, 2.6)),
        "knees straight to folded": robot(joints__front__calf=(-2 * np.pi, -1e-300)),
        "calf of 1 mm": robot(calf__length=1e-3, nominal_height=0.2),
        "no weight": robot(
            **{f"{part}__mass": 1e-6 for part in ("trunk", "thigh", "calf", "wheel")}
        ),
        "no torque": robot(actuators__leg__torque=5e-324, actuators__wheel__speed=5e-324),
        "one collision point": robot(collision_points={"trunk": [(0, 0)], "thigh": [], "calf": []}),
    }


def uneven_robot(random: np.random.Generator) -> _core.Robot:
    """A native robot whose front and rear legs differ in every number; bent shank, two hulls."""

    def link() -> _core.Link:
        length, bend = random.uniform(0.05, 0.5), random.uniform(-0.1, 0.1)
        end, knee = _core.Vec2(bend, -length), _core.Vec2(bend, -0.4 * length)
        shape = [_core.Capsule(_core.Vec2(0, 0), knee, 0.02), _core.Capsule(knee, end, 0.01)]
        return _core.Link(end, _core.Vec2(bend, -0.5 * length), random.uniform(0, 3), 0.01, shape)

    def leg(x: float) -> _core.Leg:
        calf, motors = np.sort(random.uniform(-2.8, 2.8, 2)), random.uniform(1, 50, (3, 2))
        return _core.Leg(
            _core.Vec2(x, random.uniform(-0.1, 0.1)),
            link(),
            link(),
            _core.Wheel(radius, random.uniform(0, 2), 1e-3),
            _core.Range(*np.sort(random.uniform(-3, 3, 2))),
            _core.Range(*calf),
            *(_core.Motor(*motor) for motor in motors),
            1.0 if calf.sum() > 0 else -1.0,
        )

    radius = random.uniform(0.03, 0.15)
    box = np.array([(-0.3, -0.05), (0.1, -0.05), (0.1, 0.05), (-0.3, 0.05)])
    hulls = [_core.Polygon(box), _core.Polygon(box + random.uniform(0, 0.2, 2))]
    trunk = _core.Trunk(
        random.uniform(0.1, 30), 0.1, _core.Vec2(*random.uniform(-0.1, 0.1, 2)), hulls
    )
    return _core.Robot(trunk, [leg(0.2), leg(-0.25)], 0.15, random.uniform(0.2, 0.6))


def numbers(random: np.random.Generator, shape: int | tuple[int, ...]) -> np.ndarray:
    """Ordinary numbers, and among them what 0/0 and overflow leave."""
    values = random.normal(0.0, 1.0, shape)
    odd = [np.nan, np.inf, -np.inf, 1e308, -1e308, 1e19, 5e-324, -0.0]
    return np.where(random.random(shape) < 0.2, random.choice(odd, shape), values)
