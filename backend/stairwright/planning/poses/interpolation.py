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
from typing import Literal

import numpy as np

from stairwright import _core
from stairwright.arrays import Flags, Floats
from stairwright.errors import InputError
from stairwright.planning.plan import Plan
from stairwright.planning.poses.balanced_poses import ROOM, com_ways, eased_shift
from stairwright.planning.poses.pose_reference import Reference
from stairwright.planning.poses.pose_search import BETWEEN, PoseSearch
from stairwright.planning.weights import CriticalWeights
from stairwright.robot import kinematics
from stairwright.robot.description import Robot
from stairwright.terrain.wheel_path import WheelPath, wheel_path

Mode = Literal["joint", "curve"]

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
    sound: Flags,
    shift: Floats,
) -> Floats:
    """Trunk (n, 3) moved to clear poses whose CoM, now at `com` (n,), is moved by `shift` (n,).

    First at every few samples, its change linear between them; then where that does not do.
    """
    problem, rules = search.problem, search.rules.native
    even = np.concatenate([trunk, q], axis=1)
    edges = com_ways(search.path, search.friction, s, 0.0)

    def moved_at(samples: Flags, trunks: Floats, sound: Flags) -> Floats:
        return problem.move_poses(rules, s, even, com, shift, edges, samples, trunks, sound)

    asked = ~sound | (shift != 0.0)
    places = np.flatnonzero(asked)
    coarse = np.zeros_like(sound)
    coarse[places[(np.arange(len(places)) % _COARSE == 0) | ~np.isin(places + 1, places)]] = True
    change = moved_at(coarse, trunk, np.zeros_like(sound)) - trunk
    fixed = np.flatnonzero(coarse | ~asked)
    for j in range(3):
        change[:, j] = np.interp(np.arange(len(trunk)), fixed, change[fixed, j])
    moved = trunk + change
    anywhere = np.tile([-np.inf, np.inf], (len(trunk), 1))
    sound, _ = search.sound(np.concatenate([moved, s], axis=1), anywhere)
    # Here the even pose is asked again, not the one moved nearly right.
    return moved_at(~sound, moved, sound)


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
