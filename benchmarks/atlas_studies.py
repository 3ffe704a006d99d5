"""What the atlas asks of each robot."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from stairwright.library import load_robot

DOCS = Path(__file__).parents[1] / "docs"
FRICTIONS = (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
STAIR_FRICTIONS = (0.3, 0.45, 0.6, 0.8)
TREADS = (0.18, 0.22, 0.26, 0.30, 0.34, 0.38, 0.42)
STAIR = {"kind": "stair", "rise": 0.17, "run": 0.28, "count": 3}


def studies_of(name: str) -> Iterator[tuple[str, dict[str, Any]]]:
    """The studies of one robot, by the name of their map."""
    mass = round(load_robot(name).mass, 1)
    friction = {"name": "friction", "values": list(FRICTIONS)}
    yield (
        "stairs",
        {
            "axes": [
                {"name": "stairs.tread", "values": list(TREADS)},
                {"name": "friction", "values": list(STAIR_FRICTIONS)},
                {"name": "stairs.rise", "boundary": [0.04, 0.94], "tolerance": 0.03},
            ]
        },
    )
    yield (
        "step",
        {"axes": [friction, {"name": "step.height", "boundary": [0.04, 1.24], "tolerance": 0.03}]},
    )
    yield (
        "payload",
        {
            "terrain": STAIR,
            "axes": [
                friction,
                {"name": "payload", "boundary": [0.0, mass], "tolerance": mass / 24},
            ],
        },
    )
