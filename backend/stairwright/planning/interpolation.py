"""From poses to the dense trajectory between them (eqs 23-24, and a form that keeps contact).

``joint`` is the paper's: joints and pitch linear between poses. Between poses far apart it lifts
wheels off the terrain or buries them. ``curve`` interpolates the trunk and the wheels' places on
the wheel-centre curve instead and solves the legs in closed form, so that the wheels stay on the
terrain; it is the default where poses are sparse. Plans of dense poses (``path``) use ``joint``:
their poses are placed so that it misses the curve by less than a millimetre.
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

from .plan import Plan
from .reference import Reference
from .supports import contact_forces, weight_of

Floats = NDArray[np.float64]
Mode = Literal["joint", "curve"]


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
        mode: ``joint`` or ``curve``; by default ``joint`` for dense plans and ``curve`` else.
        spacing: Largest step of progress between samples [m].
        joint_rate: Joint speed [rad/s] above which the planned time is stretched; None keeps it.

    Raises:
        InputError: If the plan has fewer than two poses.
    """
    if len(plan.poses) < 2:
        raise InputError("a trajectory needs at least two poses", ("poses",))
    robot = plan.robot_description
    if mode is None:
        mode = "joint" if plan.method == "path" else "curve"
    knots = np.array([pose.progress for pose in plan.poses])
    progress = _grid(knots, spacing)
    at = _Linear(knots, progress)
    trunk = at([(pose.x_c, pose.z_c, pose.pitch) for pose in plan.poses])
    wheel_progress = at([pose.wheel_progress for pose in plan.poses])
    q = at([pose.q for pose in plan.poses])
    time = at([(pose.time,) for pose in plan.poses])[:, 0]
    path = wheel_path(plan.terrain, robot.wheel.radius)
    if mode == "curve":
        q = _legs(robot, path, trunk, wheel_progress, q)
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


def _legs(robot: Robot, path: WheelPath, trunk: Floats, s: Floats, q: Floats) -> Floats:
    """Joints (n, 4) with the wheels on the curve; held from neighbours where out of reach."""
    wheels = path.centres(s.ravel()).reshape(-1, 2, 2)
    solved = kinematics.inverse(robot, trunk[:, 0], trunk[:, 1], trunk[:, 2], wheels)
    solved = q + (solved - q + np.pi) % (2 * np.pi) - np.pi
    limits = kinematics.limits(robot)
    for leg in (slice(0, 2), slice(2, 4)):
        good = np.all(np.isfinite(solved[:, leg]), axis=1)
        places = np.arange(len(q))
        for j in range(leg.start, leg.stop):
            known = solved[good, j] if good.any() else q[:, j]
            held = np.interp(places, places[good] if good.any() else places, known)
            solved[:, j] = np.clip(held, *limits[j])
    return solved


def _com(robot: Robot, trunk: Floats, q: Floats) -> Floats:
    frames = kinematics.forward(robot, trunk[:, 0], trunk[:, 1], trunk[:, 2], q)
    return kinematics.com(robot, trunk[:, 0], trunk[:, 1], frames)


def _stretch(time: Floats, q: Floats, joint_rate: float | None) -> Floats:
    step = np.diff(time)
    if joint_rate is not None:
        step = np.maximum(step, np.abs(np.diff(q, axis=0)).max(axis=1) / joint_rate)
    stretched: Floats = np.concatenate([[0.0], np.cumsum(np.maximum(step, 1e-9))])
    return stretched
