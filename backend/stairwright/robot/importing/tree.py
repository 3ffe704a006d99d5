"""Which of a file's joints are the four legs', by the shape of the tree and the axes alone."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass

import mujoco
import numpy as np

from stairwright.errors import InputError

from .loops import find_loops
from .report import listed
from .source import Source

_HINGE, _SLIDE = int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE)
_LEAST_TURN = 2 * math.pi - 1e-3  # rad; a joint that turns less than once is no wheel's
_PARALLEL = 0.02  # rad between the axes of thigh, calf and wheel
_MOST_UNLIKE = 0.5  # rad between axes that are meant to be parallel


@dataclass(frozen=True)
class Chain:
    """The joints of a leg, by index; `abduction` may be missing."""

    abduction: int | None
    thigh: int
    calf: int
    wheel: int

    @property
    def joints(self) -> tuple[int, ...]:
        """From the trunk outward."""
        own = () if self.abduction is None else (self.abduction,)
        return (*own, self.thigh, self.calf, self.wheel)


@dataclass(frozen=True)
class Tree:
    """A robot's parts.

    Attributes:
        legs: Four chains, in no order.
        trunk: Bodies of the trunk and all that does not move against it.
        parts: Bodies that move with each joint of the legs.
        free: Joints that are in no leg and not above the trunk: they will be held.
        steering: Joints between a calf and its wheel that turn it out of the side view: held, too.
        roots: Joints above the trunk.
    """

    legs: tuple[Chain, ...]
    trunk: list[int]
    parts: dict[int, list[int]]
    free: list[int]
    steering: list[int]
    roots: list[int]


def find_legs(source: Source, rigid: Collection[int] = ()) -> Tree:
    """Four chains of (abduction,) thigh, calf, wheel on one trunk; `rigid` joints count as none.

    Raises:
        InputError: If they are not there; names the joint or body that does not fit.
    """
    loops = find_loops(source)
    try:
        tree = _open_tree(source, rigid)
    except InputError:
        if loops:
            raise loops[0].error() from None  # which explains what is odd about the tree
        raise
    trunk = set(tree.trunk)
    for loop in loops:
        if not loop.bodies <= trunk:
            raise loop.error()
    return tree


def _open_tree(source: Source, rigid: Collection[int]) -> Tree:
    model = source.model
    own = _own_joints(source)
    above = _above(source, own)
    moving = [[j for j in path if j not in rigid] for path in _paths(source, above)]
    moving = [path for path in moving if path]
    paths = [_without_steering(source, path) for path in moving]
    wheels = [path for path in paths if _ends_in_wheel(source, path)]
    if len(wheels) != 4:
        raise InputError(_not_four(source, paths, wheels), ("file",))
    common = [j for j in wheels[0] if all(j in path for path in wheels)]
    legs = tuple(_chain(source, path[len(common) :]) for path in wheels)
    in_legs = {joint for leg in legs for joint in leg.joints}
    on_wheels = {j for path in moving if path[-1] in in_legs for j in path}
    steering = sorted(on_wheels.difference(in_legs, common))
    free = [j for j in range(model.njnt) if j not in on_wheels]
    groups: dict[int | None, list[int]] = {}
    top = int(model.jnt_bodyid[legs[0].joints[0]])
    for leg in legs:
        body = int(model.jnt_bodyid[leg.joints[0]])
        if model.body_parentid[body] == 0 or model.body_rootid[body] != model.body_rootid[top]:
            raise InputError(f"{source.body(body)!r}: the leg hangs on no trunk", ("file",))
    for body in range(1, model.nbody):
        if model.body_rootid[body] != model.body_rootid[top]:
            continue  # a floor, another machine
        joint = own[body] if own[body] is not None else _nearest(source, own, body)
        while joint is not None and joint not in in_legs:
            joint = above[joint]
        groups.setdefault(joint, []).append(body)
    root = model.body_rootid[top]
    free = [j for j in free if model.body_rootid[model.jnt_bodyid[j]] == root]
    parts = {j: groups.get(j, []) for j in in_legs}
    return Tree(legs, groups.get(None, []), parts, free, steering, common)


def _own_joints(source: Source) -> list[int | None]:
    """The last joint of each body, None where it has none."""
    model = source.model
    return [
        int(model.body_jntadr[b] + model.body_jntnum[b] - 1) if model.body_jntnum[b] else None
        for b in range(model.nbody)
    ]


def _nearest(source: Source, own: list[int | None], body: int) -> int | None:
    """The joint that moves `body`: its own, or that of the next body above which has one."""
    while body and own[body] is None:
        body = int(source.model.body_parentid[body])
    return own[body] if body else None


def _above(source: Source, own: list[int | None]) -> list[int | None]:
    """For each joint the next one towards the world."""
    model = source.model
    found: list[int | None] = []
    for joint in range(model.njnt):
        body = int(model.jnt_bodyid[joint])
        if joint > model.body_jntadr[body]:
            found.append(joint - 1)
        else:
            found.append(_nearest(source, own, int(model.body_parentid[body])))
    return found


def _paths(source: Source, above: list[int | None]) -> list[list[int]]:
    """From the outermost joint of every branch, the joints that lead to it."""
    paths = []
    for leaf in sorted(set(range(source.model.njnt)) - {j for j in above if j is not None}):
        path: list[int] = []
        joint: int | None = leaf
        while joint is not None:
            path.insert(0, joint)
            joint = above[joint]
        paths.append(path)
    return paths


def _without_steering(source: Source, path: list[int]) -> list[int]:
    """The path less the joints between its wheel and the calf, where a calf and a thigh are."""
    wheel = path[-1]
    calf = len(path) - 2
    while calf > 0 and not _alike(source, path[calf], wheel):
        calf -= 1
    if calf > 0 and _alike(source, path[calf - 1], wheel):
        return [*path[: calf + 1], wheel]
    return path


def _ends_in_wheel(source: Source, path: list[int]) -> bool:
    model = source.model
    if len(path) < 3 or any(model.jnt_type[j] != _HINGE for j in path[-3:]):
        return False
    return _turns(source, path[-1]) and _alike(source, path[-1], path[-2])


def _alike(source: Source, first: int, second: int) -> bool:
    """Whether two hinges turn about much the same axis."""
    hinges = all(source.model.jnt_type[joint] == _HINGE for joint in (first, second))
    return hinges and _lean(source, first, second) <= _MOST_UNLIKE


def _turns(source: Source, joint: int) -> bool:
    low, high = source.model.jnt_range[joint]
    return not source.model.jnt_limited[joint] or bool(high - low >= _LEAST_TURN)


def _lean(source: Source, first: int, second: int) -> float:
    """Angle between two axes, whichever way they point [rad]."""
    a, b = source.data.xaxis[first], source.data.xaxis[second]
    return math.atan2(float(np.linalg.norm(np.cross(a, b))), abs(float(a @ b)))


def _chain(source: Source, path: list[int]) -> Chain:
    """The joints of one leg, checked."""
    end = source.body(int(source.model.jnt_bodyid[path[-1]]))
    for joint in path:
        if source.model.jnt_type[joint] != _HINGE:
            raise InputError(
                f"{source.joint(joint)!r}: the joints of a leg must be hinges", ("file",)
            )
    if len(path) < 3:
        raise InputError(f"the leg that ends in {end!r} has {len(path)} joints; a leg needs "
                         "thigh, calf and wheel", ("file",))  # fmt: skip
    if len(path) > 4:
        raise InputError(_too_many(source, path, end), ("file",))
    thigh, calf, wheel = path[-3:]
    for joint in (calf, wheel):
        lean = _lean(source, thigh, joint)
        if lean > _PARALLEL:
            raise InputError(
                f"{source.joint(joint)!r}: its axis is {math.degrees(lean):.1f} degrees off that "
                f"of {source.joint(thigh)!r}; thigh, calf and wheel must turn about parallel axes",
                ("file",),
            )
    return Chain(path[0] if len(path) == 4 else None, thigh, calf, wheel)


def _too_many(source: Source, path: list[int], end: str) -> str:
    """Which joints of a long leg are to be held."""
    planar = [source.joint(joint) for joint in path[:-1] if _alike(source, joint, path[-1])]
    if len(planar) > 2:
        return (
            f"{planar[-1]!r}: one joint too many in the leg that ends in {end!r}, which bends in "
            f"its plane at {listed(planar)}; there may be a thigh and a calf: hold one in "
            f"each leg, for instance {planar[-1]}=0.3 [rad]"
        )
    names = [source.joint(joint) for joint in path]
    return (
        f"{names[0]!r}: one joint too many in the leg that ends in {end!r}, which has "
        f"{', '.join(names[:8])}; there may be an abduction, a thigh, a calf and a wheel: hold the "
        "others"
    )


def _not_four(source: Source, paths: list[list[int]], wheels: list[list[int]]) -> str:
    """Why there are not four wheels, by name."""
    ends = [source.joint(path[-1]) for path in wheels]
    if len(wheels) > 4:
        return f"{len(wheels)} wheels on legs ({listed(ends)}); there must be four"
    others = [path for path in paths if path not in wheels and len(path) >= 2]
    longest = max((len(path) for path in paths), default=0)
    for path in others:
        if len(path) < longest - 1 or source.model.jnt_type[path[-1]] != _HINGE:
            continue
        joint = source.joint(path[-1])
        body = source.body(int(source.model.jnt_bodyid[path[-1]]))
        if not _turns(source, path[-1]):
            return (
                f"{body!r} is no wheel: {joint!r}, the last joint of its leg, turns less than once "
                f"round; {len(wheels)} of four legs end in a wheel"
            )
        if len(path) >= 3:
            return (
                f"{body!r} is no wheel: the axis of {joint!r} is "
                f"{math.degrees(_lean(source, path[-1], path[-2])):.0f} degrees off that of "
                f"{source.joint(path[-2])!r}; {len(wheels)} of four legs end in a wheel"
            )
    if not wheels:
        what = f"the longest chain of joints has {longest}" if longest else "nothing moves"
        return f"no leg with thigh, calf and wheel: {what}"
    what = "leg ends" if len(wheels) == 1 else "legs end"
    return f"{len(wheels)} {what} in a wheel ({listed(ends)}); there must be four"
