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
from numpy.typing import NDArray

from stairwright.errors import InputError
from stairwright.robot import kinematics
from stairwright.robot.description import Robot
from stairwright.terrain.wheel_path import WheelPath, wheel_path

from .balance_way import com_ways, eased_shift
from .clearance import clearance, legs_apart
from .plan import Plan
from .pose_search import APART, CLEARANCE, PoseSearch
from .reference import Reference
from .supports import contact_forces, weight_of
from .weights import CriticalWeights

Floats = NDArray[np.float64]
Mode = Literal["joint", "curve"]

_ROUNDS = 4  # of asking for the CoM's place
_NEAR = 1e-3  # m; such an error of the CoM is none
_COARSE = 4  # samples between those where corrections are solved for


def reference(
    plan: Plan,
    mode: Mode | None = None,
    *,
    spacing: float = 0.005,
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
        forces=contact_forces(weight_of(robot), com[:, 0], contacts, normals),
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
    plan: Plan,
    path: WheelPath,
    progress: Floats,
    trunk: Floats,
    s: Floats,
    q: Floats,
) -> tuple[Floats, Floats]:
    """Trunk (n, 3) and joints (n, 4) with the wheels on the curve, limits and clearance kept.

    Where a linear trunk is out of the legs' reach, touches the terrain or leaves the centre of
    mass where the friction cones cannot hold it, the nearest pose that does not takes its place;
    critical poses beside such places move with them. Where there is none, the joints stay at
    their limits and the wheels leave the curve.
    """
    robot = plan.robot_description
    solved, good = _legs(robot, path, trunk, s, q)
    com = _com(robot, trunk, np.where(np.isfinite(solved), solved, q))[:, 0]
    shift = eased_shift(progress, com, *com_ways(path, plan.friction, s))
    if good.all() and not shift.any():
        return trunk, solved

    search = PoseSearch(robot, path, plan.friction, CriticalWeights())
    # First at every few samples, the trunk's change linear between them; then where that fails.
    asked = np.flatnonzero(~good | (shift != 0.0))
    coarse = asked[(np.arange(len(asked)) % _COARSE == 0) | ~np.isin(asked + 1, asked)]
    fixed = np.union1d(coarse, np.flatnonzero(good & (shift == 0.0)))
    change = np.zeros_like(trunk)
    start: Floats | None = None
    for i in coarse:
        found = _balanced(search, s[i], trunk[i], q[i], shift[i], com[i] + shift[i], start)
        if found is not None:
            change[i], start = found[:3] - trunk[i], found
    for j in range(3):
        change[:, j] = np.interp(np.arange(len(trunk)), fixed, change[fixed, j])
    trunk = trunk + change
    solved, good = _legs(robot, path, trunk, s, q)
    for i in np.flatnonzero(~good):
        start = np.concatenate([trunk[i - 1], solved[i - 1], s[i]]) if i and good[i - 1] else start
        nearest = search.nearest(s[i], trunk[i], q[i], start)
        if nearest.solved:
            trunk[i], solved[i], start = nearest.x[:3], nearest.x[3:7], nearest.x
            good[i] = True
    places = np.arange(len(q))
    if good.any():
        for j in range(4):
            solved[:, j] = np.interp(places, places[good], solved[good, j])
    else:
        solved = q
    limits = kinematics.limits(robot)
    return trunk, np.clip(solved, limits[:, 0], limits[:, 1])


def _balanced(
    search: PoseSearch,
    wheels: Floats,
    trunk: Floats,
    q: Floats,
    shift: float,
    com_x: float,
    start: Floats | None,
) -> Floats | None:
    """Variables (9,) of the clear pose nearest to `trunk` whose CoM is moved by `shift`, if any."""
    target = trunk.copy()
    target[0] += shift
    best: Floats | None = None
    for _ in range(_ROUNDS):
        found = search.nearest(wheels, target, q, start)
        if not found.solved:
            break
        best = start = found.x
        # Legs move less than the trunk, so the CoM does: ask for what is still missing.
        missing = com_x - _com(search.robot, best[None, :3], best[None, 3:7])[0, 0]
        if shift == 0.0 or abs(missing) < _NEAR:
            break
        target[0] += 1.5 * missing
    return best


def _legs(
    robot: Robot, path: WheelPath, trunk: Floats, s: Floats, q: Floats
) -> tuple[Floats, NDArray[np.bool_]]:
    """Joints (n, 4) to the wheels' places (NaN out of reach), and which poses (n,) are sound."""
    limits = kinematics.limits(robot)
    wheels = path.centres(s.ravel()).reshape(-1, 2, 2)
    solved = kinematics.inverse(robot, trunk[:, 0], trunk[:, 1], trunk[:, 2], wheels)
    solved = q + (solved - q + np.pi) % (2 * np.pi) - np.pi
    good = np.all((solved >= limits[:, 0] - 1e-9) & (solved <= limits[:, 1] + 1e-9), axis=1)
    for i in np.flatnonzero(good):
        good[i] = _clear(robot, path, trunk[i], solved[i])
    return solved, good


def _clear(robot: Robot, path: WheelPath, trunk: Floats, q: Floats) -> bool:
    pose = (float(trunk[0]), float(trunk[1]), float(trunk[2]))
    gap, _ = clearance(robot, path.vertices, pose, q)
    return gap >= CLEARANCE - 1e-6 and legs_apart(robot, pose, q) >= APART - 1e-6


def _com(robot: Robot, trunk: Floats, q: Floats) -> Floats:
    frames = kinematics.forward(robot, trunk[:, 0], trunk[:, 1], trunk[:, 2], q)
    return kinematics.com(robot, trunk[:, 0], trunk[:, 1], frames)


def _stretch(time: Floats, q: Floats, joint_rate: float | None) -> Floats:
    step = np.diff(time)
    if joint_rate is not None:
        step = np.maximum(step, np.abs(np.diff(q, axis=0)).max(axis=1) / joint_rate)
    stretched: Floats = np.concatenate([[0.0], np.cumsum(np.maximum(step, 1e-9))])
    return stretched
