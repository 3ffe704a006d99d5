"""HTML: one file that replays a rollout in 3-D, with plots, offline and without a server.

The page (``replay/``) is our own small WebGL renderer: no library, no network, and a policy in the
file that forbids any. Series go in as base64 float32, thinned to at most `MAX_SAMPLES`.
"""

from __future__ import annotations

import base64
import html
import json
import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from stairwright.robot.description import Robot
from stairwright.simulation.result import Rollout

from .columns import FRAMES, SHOWN_HALF_WIDTH, UNITS

MAX_SAMPLES = 2500
_LAYOUT = (
    ("time", 1),
    ("base_position", 3),
    ("base_quaternion", 4),
    ("q", 12),
    ("q_desired", 12),
    ("torque", 12),
    ("pitch", 1),
    ("pitch_desired", 1),
    ("contact_force", 8),
)


def rollout_html(rollout: Rollout) -> bytes:
    """The whole page."""
    # Names and reasons are the user's text: no "<" of theirs may open a tag or end the script.
    run = json.dumps(_run(rollout), allow_nan=False).replace("<", "\\u003c")
    title = html.escape(f"Stairwright: {rollout.terrain.name}, {rollout.outcome}")
    page = _part("replay.html")
    for name, text in (
        ("__TITLE__", title),
        ("__STYLE__", _part("replay.css")),
        ("__SCRIPT__", _script()),
        ("__RUN__", run),
    ):
        page = page.replace(name, text, 1)
    return page.encode()


@cache
def _script() -> str:
    """The scripts in the order of their numbers: later ones use what earlier ones define."""
    files = sorted((Path(__file__).parent / "replay").glob("*.js"))
    return "\n".join(path.read_text(encoding="utf-8") for path in files)


@cache
def _part(name: str) -> str:
    return (Path(__file__).parent / "replay" / name).read_text(encoding="utf-8")


def _run(rollout: Rollout) -> dict[str, Any]:
    return {
        "schema": rollout.schema_,
        "id": rollout.id,
        "plan_id": rollout.plan_id,
        "outcome": rollout.outcome,
        "reason": rollout.reason,
        "friction": rollout.friction,
        "terrain": {
            "name": rollout.terrain.name,
            "vertices": rollout.terrain.vertices.tolist(),
            "hash": rollout.terrain_hash,
        },
        "half_width": SHOWN_HALF_WIDTH,
        "robot": {**_robot(rollout.robot_description), "hash": rollout.robot_hash},
        "metrics": _metrics(rollout),
        "series": _series(rollout),
        "units": UNITS,
        "frames": FRAMES,
        "source": (
            f"rollout {rollout.id} · plan {rollout.plan_id} · terrain {rollout.terrain_hash} · "
            f"robot {rollout.robot_hash} · seed {rollout.seed} · {UNITS}"
        ),
    }


def _robot(robot: Robot) -> dict[str, Any]:
    return {
        "name": robot.name,
        "trunk": [{"points": piece.points, "width": piece.width} for piece in robot.body.outline],
        "hips": {"front": robot.hips.front, "rear": robot.hips.rear},
        "half_track": robot.hips.half_track,
        "legs": [
            {
                part: {"length": link.length, "capsules": link.capsules}
                for part, link in (("thigh", leg.thigh), ("calf", leg.calf))
            }
            for leg in robot.legs
        ],
        "wheel": {"radius": robot.wheel.radius, "width": robot.wheel.width},
    }


def _metrics(rollout: Rollout) -> list[tuple[str, str]]:
    m = rollout.metrics
    limit = float(rollout.robot_description.torque_limits[:, :2].max())
    return [
        ("Duration", f"{m.duration:.1f} s"),
        ("Pitch error max", f"{math.degrees(m.pitch_error_max):.1f}°"),
        ("Pitch error rms", f"{math.degrees(m.pitch_error_rms):.1f}°"),
        ("Joint error rms", f"{math.degrees(m.joint_error_rms):.1f}°"),
        (f"Torque of {limit:g} Nm", f"{m.torque_peak:.1f} Nm"),
        ("Link contacts", str(m.link_contacts)),
        ("Energy", f"{m.energy:.0f} J"),
    ]


def _series(rollout: Rollout) -> dict[str, Any]:
    count = len(rollout.series)
    chosen = np.arange(0, count, max(1, math.ceil(count / MAX_SAMPLES)))
    if count and chosen[-1] != count - 1:
        chosen = np.append(chosen, count - 1)  # the end is what people look at
    parts = [
        np.asarray(getattr(rollout.series, name), float)[chosen].reshape(len(chosen), width)
        for name, width in _LAYOUT
    ]
    data = np.concatenate([part.astype("<f4").ravel() for part in parts])
    return {
        "layout": _LAYOUT,
        "count": len(chosen),
        "data": base64.b64encode(data.tobytes()).decode("ascii"),
    }
