"""What ros2_control's joint_trajectory_controller does with a trajectory, written from its docs.

It accepts times that rise strictly, fields as long as the joints' names and a last point at rest.
Between two points it follows the polynomial that meets their positions and velocities (cubic), and
their accelerations too where both have them (quintic). Where positions are missing it integrates
velocities by Heun's method from the state that it finds; it deals so with every point but one at
time 0. https://control.ros.org: joint_trajectory_controller, Trajectory Representation.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np


def times(trajectory: Any) -> np.ndarray:
    """Times of the points [s]."""
    after = [point.time_from_start for point in trajectory.points]
    return np.array([t.sec + t.nanosec * 1e-9 for t in after])


def field(trajectory: Any, name: str) -> np.ndarray:
    """One field of all points (n, joints)."""
    return np.array([getattr(point, name) for point in trajectory.points])


def accepted(trajectory: Any, joints: list[str], *, effort: bool, integrate: bool = False) -> bool:
    """Whether a controller of `joints` takes it.

    Args:
        trajectory: The message.
        joints: The controller's.
        effort: It has an effort command interface; else points with efforts are refused.
        integrate: ``allow_integration_in_goal_trajectories``.
    """
    if not trajectory.points or sorted(trajectory.joint_names) != sorted(joints):
        return False
    if (np.diff([t.sec * 10**9 + t.nanosec for t in
                 (p.time_from_start for p in trajectory.points)]) <= 0).any():  # fmt: skip
        return False
    if np.abs(trajectory.points[-1].velocities).max(initial=0.0) > np.finfo(np.float32).eps:
        return False
    for point in trajectory.points:
        given = {
            name: len(getattr(point, name))
            for name in ("positions", "velocities", "accelerations", "effort")
        }
        if any(count not in (0, len(joints)) for count in given.values()):
            return False
        if given["effort"] and not effort:
            return False
        if not given["positions"] and not (integrate and given["velocities"]):
            return False
    first = times(trajectory)[0]
    return bool(field(trajectory, "positions").size or first > 0.0)


def spline(trajectory: Any, degree: int) -> list[np.ndarray]:
    """Coefficients (degree + 1, joints) of each segment's polynomial in the time since its start.

    Args:
        trajectory: The message.
        degree: 3 from positions and velocities, 5 with accelerations too.
    """
    fields = ("positions", "velocities", "accelerations")[: (degree + 1) // 2]
    values = [field(trajectory, name) for name in fields]
    at = times(trajectory)
    made = []
    for i, span in enumerate(np.diff(at)):
        rows, right = [], []
        for order, given in enumerate(values):
            for t, k in ((0.0, i), (span, i + 1)):
                rows.append(_powers(t, degree, order))
                right.append(given[k])
        # Scaled so that the powers of a short span do not differ by twenty orders of magnitude.
        scale = span ** np.arange(degree + 1.0)
        made.append(np.linalg.solve(np.array(rows) / scale, np.array(right)) / scale[:, None])
    return made


def sampled(trajectory: Any, degree: int, order: int, per_segment: int = 5) -> np.ndarray:
    """A derivative of the spline, `per_segment` + 1 samples in each segment, both ends included."""
    out = []
    spans = np.diff(times(trajectory))
    for coefficients, span in zip(spline(trajectory, degree), spans, strict=True):
        for t in np.linspace(0.0, span, per_segment + 1):
            out.append(_powers(t, degree, order) @ coefficients)
    return np.array(out)


def integrated(trajectory: Any) -> np.ndarray:
    """Positions (n, joints) from velocities alone, from 0 and rest at time 0, by Heun's method."""
    speed = np.vstack([np.zeros(len(trajectory.joint_names)), field(trajectory, "velocities")])
    span = np.diff(np.append(0.0, times(trajectory)))
    return np.cumsum((speed[:-1] + speed[1:]) / 2 * span[:, None], axis=0)


def _powers(t: float, degree: int, order: int) -> np.ndarray:
    """The row that takes a polynomial's coefficients to its derivative at `t`."""
    return np.array(
        [math.perm(k, order) * t ** (k - order) if k >= order else 0.0 for k in range(degree + 1)]
    )
