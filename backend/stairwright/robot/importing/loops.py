"""Constraints that close a chain of bodies, or tie a joint to another."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mujoco

from stairwright.errors import InputError

from .source import Source

_BODIES = (int(mujoco.mjtEq.mjEQ_CONNECT), int(mujoco.mjtEq.mjEQ_WELD))
_JOINT, _BODY = int(mujoco.mjtEq.mjEQ_JOINT), int(mujoco.mjtObj.mjOBJ_BODY)


@dataclass(frozen=True)
class Loop:
    """What ties the parts of a robot together besides its joints.

    Attributes:
        bodies: That it ties.
        message: What it is, by name.
    """

    bodies: frozenset[int]
    message: str

    def error(self) -> InputError:
        """For a robot whose legs it is in."""
        return InputError(self.message, ("file",))


def find_loops(source: Source) -> list[Loop]:
    """Active equality constraints of MJCF, and URDF's joints that mimic another."""
    model = source.model
    found = [_loop(source, k) for k in range(model.neq) if model.eq_active0[k]]
    for name, other in source.mimics.items():
        bodies = frozenset(
            int(model.jnt_bodyid[j]) for j in range(model.njnt) if source.joint(j) in (name, other)
        )
        found.append(Loop(bodies, f"{name!r} follows {other!r}: legs must be open chains"))
    return found


def _loop(source: Source, k: int) -> Loop:
    model: Any = source.model
    kind = int(model.eq_type[k])
    name = model.equality(k).name or mujoco.mjtEq(kind).name.removeprefix("mjEQ_").lower()
    first, second = int(model.eq_obj1id[k]), int(model.eq_obj2id[k])
    ends, where = [first, second], name
    if kind in _BODIES and int(model.eq_objtype[k]) != _BODY:
        ends = [int(model.site_bodyid[site]) for site in (first, second)]
    elif kind == _JOINT:
        ends = [int(model.jnt_bodyid[joint]) for joint in (first, second) if joint >= 0]
        where = source.joint(first)
    elif kind not in _BODIES:  # of a tendon, whose joints may be anywhere
        ends = list(range(model.nbody))
    if kind in _BODIES:
        where = source.body(ends[0])
    return Loop(
        frozenset(ends), f"{where!r}: equality {name!r} closes a chain; legs must be open chains"
    )
