"""Joints that a user wants rigid: an arm's that is folded, an ankle's that is one too many."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from stairwright.arguments import as_number
from stairwright.errors import InputError
from stairwright.robot.description import MOST_HELD

from .report import Notes, listed

if TYPE_CHECKING:  # the web process checks what is asked for, and does without MuJoCo
    from .source import Source


def written_hold(texts: Sequence[str]) -> dict[str, float]:
    """Joints and positions written as ``joint=position``.

    Raises:
        InputError: If one is written in another way, or a joint named twice.
    """
    hold: dict[str, float] = {}
    for text in texts:
        name, equals, value = text.rpartition("=")
        try:
            position = float(value)
        except ValueError:
            equals = ""
        if not equals or not name:
            raise InputError(f"{text[:80]!r} must be JOINT=RAD, as in arm_joint=0.5", ("hold",))
        if name in hold:
            raise InputError(f"{name!r} is named twice", ("hold",))
        hold[name] = position
    return checked_hold(hold)


def checked_hold(hold: Mapping[str, float]) -> dict[str, float]:
    """Names and finite positions [rad or m].

    Raises:
        InputError: If one is no number, or there are too many.
    """
    if not isinstance(hold, Mapping) or len(hold) > MOST_HELD:
        raise InputError(f"must be at most {MOST_HELD} joints and their positions", ("hold",))
    checked = {}
    for name, value in hold.items():
        try:
            position = as_number(value, "hold")
        except InputError:
            position = math.nan
        if not math.isfinite(position):
            raise InputError(f"{name!r}: must be a number [rad or m]", ("hold",))
        checked[str(name)] = position
    return checked


def hold_joints(source: Source, hold: Mapping[str, float], notes: Notes) -> dict[int, float]:
    """Put joints where they are to be held; their positions by index.

    Raises:
        InputError: If the file has no such joint, or it has no single position.
    """
    names = {source.joint(joint): joint for joint in range(source.model.njnt)}
    held = {}
    for name, position in hold.items():
        joint = names.get(name)
        if joint is None:
            text = f"there is no joint {name[:80]!r}; there are {listed(names)}"
            raise InputError(text, ("hold",))
        if source.unit(joint) is None:
            raise InputError(f"{name!r} has no single position", ("hold",))
        note_range(source, joint, position, notes)
        held[joint] = position
    source.set(held)
    return held


def note_range(source: Source, joint: int, position: float, notes: Notes) -> None:
    """Say so where a joint is held out of its range."""
    low, high = source.model.jnt_range[joint]
    if source.model.jnt_limited[joint] and not low - 1e-6 <= position <= high + 1e-6:
        notes.warn(
            f"{source.joint(joint)!r} is held at {position:.4g} {source.unit(joint)}, out of its "
            f"range {low:.4g}..{high:.4g}"
        )
