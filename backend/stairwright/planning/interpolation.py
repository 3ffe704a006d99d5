"""From poses to the dense trajectory between them (eqs 23-24, and a form that keeps contact).

``joint`` is the paper's: joints and pitch linear between poses. Between poses far apart it lifts
wheels off the terrain or buries them. ``curve`` interpolates the trunk and the wheels' places on
the wheel-centre curve instead and solves the legs in closed form, so that the wheels stay on the
terrain; where that is out of reach, touches the terrain or tips the robot, the nearest pose that
does not takes its place. It is the default where poses are sparse. Plans of dense poses (``path``)
use ``joint``: their poses are placed so that it misses the curve by less than a millimetre.
"""

from __future__ import annotations

import itertools
import math
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from stairwright import _core
from stairwright.errors import InputError
from stairwright.robot import kinematics
from stairwright.robot.description import Robot
from stairwright.terrain.wheel_path import WheelPath, wheel_path

from .balance_way import ROOM, com_ways, eased_shift
from .plan import Plan
from .pose_search import BETWEEN, PoseSearch
from .reference import Reference
from .weights import CriticalWeights

Floats = NDArray[np.float64]
Mode = Literal["joint", "curve"]

_ROOMS = (0.015, 0.006, 0.002)  # m that the CoM keeps from where balance ends, if it must
_SHARES = (0.75, 0.5, 0.25, 0.0)  # of the way that the CoM should move, where no move balances
_FREE = (-np.inf, np.inf)
_COARSE = 8  # samples between those where corrections are solved for


def reference(
    plan: Plan,
    mode: Mode | None = None,
    *,
    spacing: float = 0.0025,
    joint_rate: float | None = 1.5,
) -> Reference:
    """The trajectory of `plan`, sampled at its poses and at most `spacing` of progress apart.

    Args:
        plan: Any method's plan with at least two poses.
        mode: ``joint`` or ``curve``; by default ``curve`` for critical poses and ``joint`` for the
            dense poses of the other methods.
        spacing: Largest step of progress between samples [m].
        joint_rate: Joint speed [rad/s] above which the planned time is stretched; None keeps it.

    Raises:
        InputError: If the plan has fewer than two poses.
    """
    if len(plan.poses) < 2:
        raise InputError("a trajectory needs at least two poses", ("poses",))
    robot = plan.robot_description
    if mode is None:
        mode = "curve" if plan.method == "critical" else "joint"
    knots = np.array([pose.progress for pose in plan.poses])
    progress = _grid(knots, spacing)
    at = _Linear(knots, progress)
    trunk = at([(pose.x_c, pose.z_c, pose.pitch) for pose in plan.poses])
    wheel_progress = at([pose.wheel_progress for pose in plan.poses])
    q = at([pose.q for pose in plan.poses])
    time = at([(pose.time,) for pose in plan.poses])[:, 0]
    path = wheel_path(plan.terrain, robot.wheel.radius)
    if mode == "curve":
        trunk, q = _on_curve(plan, path, progress, trunk, wheel_progress, q)
    com = _com(robot, trunk, q)
    normals = path.normals(wheel_progress.ravel()).reshape(-1, 2, 2)
    contacts = path.contacts(wheel_progress.ravel()).reshape(-1, 2, 2)
    return Reference(
        progress=progress,
        time=_stretch(time, q, joint_rate),
        trunk=trunk,
        q=q,
        wheel_progress=wheel_progress,
        com=com,
        normals=normals,
        contacts=contacts,
        forces=robot.mass * _core.GRAVITY * _core.resting_forces(com[:, 0], contacts, normals),
    )


class _Linear:
    """Linear interpolation of rows given at `knots`, read at `places`."""

    def __init__(self, knots: Floats, places: Floats) -> None:
        self.right = np.clip(np.searchsorted(knots, places, side="right"), 1, len(knots) - 1)
        left = self.right - 1
        self.share = ((places - knots[left]) / (knots[self.right] - knots[left]))[:, None]

    def __call__(self, rows: object) -> Floats:
        values = np.asarray(rows, dtype=float)
        mixed: Floats = (1.0 - self.share) * values[self.right - 1] + self.share * values[
            self.right
        ]
        return mixed


def _grid(knots: Floats, spacing: float) -> Floats:
    parts = [
        np.linspace(a, b, max(1, int(np.ceil((b - a) / spacing - 1e-9))), endpoint=False)
        for a, b in itertools.pairwise(knots)
    ]
    return np.concatenate([*parts, knots[-1:]])


def _on_curve(
    plan: Plan, path: WheelPath, progress: Floats, trunk: Floats, s: Floats, q: Floats
) -> tuple[Floats, Floats]:
    """Trunk (n, 3) and joints (n, 4) with the wheels on the curve, limits and clearance kept.

    Where a linear trunk is out of the legs' reach, touches the terrain or leaves the centre of
    mass where the friction cones cannot hold it, the nearest pose that does not takes its place;
    critical poses beside such places move with them. Where no pose is balanced, balance gives way;
    where none reaches, the wheels leave the curve, with joints between those beside.
    """
    search = PoseSearch(plan.robot_description, path, plan.friction, CriticalWeights())
    ways = com_ways(search.path, search.friction, s, ROOM)
    anywhere = np.tile([-np.inf, np.inf], (len(s), 1))
    sound, solved = search.sound(np.concatenate([trunk, s], axis=1), anywhere)
    com = _com(search.robot, trunk, np.where(np.isfinite(solved), solved, q))[:, 0]
    shift = eased_shift(progress, com, *ways.T)
    if not sound.all() or shift.any():
        trunk = _moved(search, trunk, s, q, com, sound, shift)
        poses = np.concatenate([trunk, s], axis=1)
        sound, solved = search.sound(poses, anywhere, BETWEEN)
    places = np.arange(len(q))
    if not sound.any():
        return trunk, q
    for j in range(4):
        solved[:, j] = np.interp(places, places[sound], solved[sound, j])
    limits = kinematics.limits(search.robot)
    return trunk, np.clip(solved, limits[:, 0], limits[:, 1])


def _moved(
    search: PoseSearch,
    trunk: Floats,
    s: Floats,
    q: Floats,
    com: Floats,
    sound: NDArray[np.bool_],
    shift: Floats,
) -> Floats:
    """Trunk (n, 3) moved to clear poses whose CoM, now at `com` (n,), is moved by `shift` (n,).

    First at every few samples, its change linear between them; then where that does not do.
    """
    count = len(trunk)
    edges = com_ways(search.path, search.friction, s, 0.0)
    asked = np.flatnonzero(~sound | (shift != 0.0))
    coarse = asked[(np.arange(len(asked)) % _COARSE == 0) | ~np.isin(asked + 1, asked)]
    fixed = np.union1d(coarse, np.flatnonzero(sound & (shift == 0.0)))
    change = np.zeros_like(trunk)
    start: Floats | None = None
    for i in coarse:
        found = _nearest(search, s[i], trunk[i], q[i], com[i], shift[i], edges[i], start)
        if found is not None:
            change[i], start = found[:3] - trunk[i], found
    for j in range(3):
        change[:, j] = np.interp(np.arange(count), fixed, change[fixed, j])
    moved = trunk + change
    anywhere = np.tile([-np.inf, np.inf], (count, 1))
    sound, solved = search.sound(np.concatenate([moved, s], axis=1), anywhere)
    for i in np.flatnonzero(~sound):
        start = np.concatenate([moved[i - 1], solved[i - 1], s[i]]) if i and sound[i - 1] else start
        found = _nearest(search, s[i], trunk[i], q[i], com[i], shift[i], edges[i], start)
        if found is not None:
            moved[i], solved[i], start = found[:3], found[3:7], found
            sound[i] = True
    return moved


def _nearest(
    search: PoseSearch,
    wheels: Floats,
    trunk: Floats,
    q: Floats,
    com: float,
    shift: float,
    way: Floats,
    start: Floats | None,
) -> Floats | None:
    """Variables (9,) of the clear pose nearest to `trunk` with its CoM moved by `shift`, if any.

    Where the legs do not allow that, by as much of it as they do; balance ends at `way` (2,).
    """
    wanted = np.concatenate([trunk, q])
    for move in _moves(com, shift, way) if shift else (0.0,):
        place = com + move
        wanted[0] = trunk[0] + move
        low, high = (place, np.inf) if shift > 0.0 else (-np.inf, place)
        found = search.nearest(wheels, wanted, start, (low, high) if move else _FREE)
        if found.solved:
            return found.x
    return None


def _moves(com: float, shift: float, way: Floats) -> list[float]:
    """Moves of the CoM to try [m]: all of it, then with less and less room, then part of it."""
    need = way[0] - com if shift > 0.0 else way[1] - com  # to where the room ends
    inward = math.copysign(1.0, shift)
    edges = [need + inward * room for room in _ROOMS]
    less = [move for move in edges if 0.0 < move / shift < 1.0]
    return [shift, *less, *(share * shift for share in _SHARES)]


def _com(robot: Robot, trunk: Floats, q: Floats) -> Floats:
    frames = kinematics.forward(robot, trunk[:, 0], trunk[:, 1], trunk[:, 2], q)
    x, z, pitch = trunk.T
    return kinematics.com(robot, x, z, pitch, frames)


def _stretch(time: Floats, q: Floats, joint_rate: float | None) -> Floats:
    step = np.diff(time)
    if joint_rate is not None:
        step = np.maximum(step, np.abs(np.diff(q, axis=0)).max(axis=1) / joint_rate)
    stretched: Floats = np.concatenate([[0.0], np.cumsum(np.maximum(step, 1e-9))])
    return stretched
