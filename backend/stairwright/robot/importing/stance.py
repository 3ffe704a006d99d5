"""How high a robot stands: as one of its file's keyframes, or with its knees bent as usual."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from .leg import SideLeg
from .pair import Pair
from .report import Notes
from .source import Source

_KNEE = 1.5  # rad; how far the A1 and its kin bend their knees to stand
_LEVEL = 0.02  # m between front and rear wheels of a robot that stands
_NAMES = ("home", "stand", "standing", "init", "default", "initial_position")


def nominal_height(
    source: Source, legs: dict[str, SideLeg], pairs: tuple[Pair, Pair], radius: float, notes: Notes
) -> float:
    """Height of the trunk point above the ground, standing [m]."""
    height = _of_keyframe(source, legs, pairs, radius, notes)
    if height is not None:
        return height
    heights = [
        _bent(pair) - pair_height
        for pair, pair_height in zip(pairs, _hip_heights(pairs), strict=True)
    ]
    height = min(heights) + radius
    notes.assume(
        f"nominal_height {height:.4g} m: wheels under the hips, knees bent by {_KNEE:g} rad or as "
        "far as they can",
        "nominal_height",
    )
    return height


def _hip_heights(pairs: tuple[Pair, Pair]) -> list[float]:
    """Of the hips above the trunk point [m]."""
    middle = (pairs[0].hip[1] + pairs[1].hip[1]) / 2
    return [float(pair.hip[1] - middle) for pair in pairs]


def _bent(pair: Pair) -> float:
    """Distance of a wheel below its hip, knee bent as usual [m]."""
    low, high = pair.limits[1]
    back = low if abs(low) > abs(high) else high
    knee = min(max(math.copysign(_KNEE, back), low), high)
    thigh, calf = pair.lengths
    reach = math.sqrt(thigh**2 + calf**2 + 2 * thigh * calf * math.cos(knee))
    # The thigh turns so far that the wheel comes under the hip, if it can.
    lean = math.atan2(calf * math.sin(knee), thigh + calf * math.cos(knee))
    angle = min(max(-lean, pair.limits[0][0]), pair.limits[0][1])
    return reach * math.cos(angle + lean)


def _of_keyframe(
    source: Source, legs: dict[str, SideLeg], pairs: tuple[Pair, Pair], radius: float, notes: Notes
) -> float | None:
    model = source.model
    keys = sorted(range(model.nkey), key=lambda k: model.key(k).name.lower() not in _NAMES)
    for key in keys:
        drops = [_drop(model, model.key_qpos[key], leg) for leg in legs.values()]
        if any(drop is None for drop in drops):
            continue
        wheels = np.array(drops, float)
        if np.ptp(wheels) > _LEVEL or wheels.min() <= 0:
            continue
        above = _hip_heights(pairs)
        height = float(wheels.mean()) - sum(above) / 2 + radius
        name = model.key(key).name or str(key)
        text = f"nominal_height {height:.4g} m: as in the keyframe {name!r}"
        notes.assume(text, "nominal_height")
        return height
    return None


def _drop(model: Any, qpos: Any, leg: SideLeg) -> float | None:
    """How far a wheel lies below its hip in a keyframe [m]; None if a joint is out of range."""
    angles = []
    for joint, own, (low, high) in zip(
        (leg.chain.thigh, leg.chain.calf), leg.maps[:2], leg.ranges, strict=True
    ):
        angle = own.sign * float(qpos[model.jnt_qposadr[joint]]) + own.offset
        if not low - 1e-3 <= angle <= high + 1e-3:
            return None
        angles.append(angle)
    thigh, calf = leg.lengths
    return thigh * math.cos(angles[0]) + calf * math.cos(angles[0] + angles[1])
