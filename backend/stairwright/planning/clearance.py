"""Exact distances of one pose: trunk and links from the terrain, front leg from rear leg (numba).

The trunk is a box, links are capsules. Distances are negative where bodies overlap: then the depth
of the deepest point found on a 1 mm raster.
"""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.robot import kinematics
from stairwright.robot.description import Robot
from stairwright.terrain.wheel_path import distance_to_profile, ground_height

Floats = NDArray[np.float64]

_RASTER = 1e-3  # m
_FAR = 0.5  # m; larger distances are cut off here


def clearance(
    robot: Robot, vertices: Floats, trunk: tuple[float, float, float], q: Floats
) -> tuple[float, Floats]:
    """Least distance of trunk and links from the terrain [m], and where on the robot (2,).

    Args:
        robot: The robot.
        vertices: (n, 2) profile.
        trunk: x, z [m] and pitch [rad].
        q: (4,) planar joints.
    """
    segments, radii = bodies(robot, trunk, q)
    best, at_x, at_z = least_clearance(np.ascontiguousarray(vertices), segments, radii)
    return float(best), np.array([at_x, at_z])


def bodies(robot: Robot, trunk: tuple[float, float, float], q: Floats) -> tuple[Floats, Floats]:
    """Segments (8, 2, 2) and radii (8,): four sides of the trunk, front links, rear links."""
    x, z, pitch = (np.asarray(value, float) for value in trunk)
    frames = kinematics.forward(robot, x, z, pitch, q)
    half = np.array([robot.trunk.size[0], robot.trunk.size[2]]) / 2
    box = np.array([x, z]) + kinematics.rotate(
        np.full(4, pitch), half * np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]])
    )
    sides = [np.stack([box[k], box[(k + 1) % 4]]) for k in range(4)]
    links = []
    for leg in range(2):
        links.append(np.stack([frames.hips[leg], frames.knees[leg]]))
        links.append(np.stack([frames.knees[leg], frames.wheels[leg]]))
    thigh, calf = robot.thigh.radius, robot.calf.radius
    return np.stack([*sides, *links]), np.array([0.0] * 4 + [thigh, calf, thigh, calf])


def legs_apart(robot: Robot, trunk: tuple[float, float, float], q: Floats) -> float:
    """Least distance between links and wheels of the front and of the rear leg [m]."""
    segments, radii = bodies(robot, trunk, q)
    wheel = robot.wheel.radius
    front = [(*segments[4], radii[4]), (*segments[5], radii[5]), (segments[5][1],) * 2 + (wheel,)]
    rear = [(*segments[6], radii[6]), (*segments[7], radii[7]), (segments[7][1],) * 2 + (wheel,)]
    return float(
        min(_segments_apart(a, b, c, d) - r1 - r2 for a, b, r1 in front for c, d, r2 in rear)
    )


@nb.njit(cache=True)
def _point_segment(x: float, z: float, ax: float, az: float, bx: float, bz: float) -> float:
    dx, dz = bx - ax, bz - az
    square = dx * dx + dz * dz
    t = 0.0 if square < 1e-18 else ((x - ax) * dx + (z - az) * dz) / square
    t = min(1.0, max(0.0, t))
    return math.hypot(x - ax - t * dx, z - az - t * dz)


@leaf
def _segments_apart(a: Floats, b: Floats, c: Floats, d: Floats) -> float:
    ux, uz, vx, vz = b[0] - a[0], b[1] - a[1], d[0] - c[0], d[1] - c[1]
    det = ux * vz - uz * vx
    if abs(det) > 1e-15:
        s = ((c[0] - a[0]) * vz - (c[1] - a[1]) * vx) / det
        t = ((c[0] - a[0]) * uz - (c[1] - a[1]) * ux) / det
        if 0.0 <= s <= 1.0 and 0.0 <= t <= 1.0:
            return 0.0
    return min(
        min(
            _point_segment(a[0], a[1], c[0], c[1], d[0], d[1]),
            _point_segment(b[0], b[1], c[0], c[1], d[0], d[1]),
        ),
        min(
            _point_segment(c[0], c[1], a[0], a[1], b[0], b[1]),
            _point_segment(d[0], d[1], a[0], a[1], b[0], b[1]),
        ),
    )


@leaf
def least_clearance(p: Floats, segments: Floats, radii: Floats) -> tuple[float, float, float]:
    """Least distance of `bodies` from the profile `p`, and where (x, z)."""
    best, at_x, at_z = _FAR, np.nan, np.nan
    for k in range(len(segments)):
        a, b, r = segments[k, 0], segments[k, 1], radii[k]
        low, high = min(a[0], b[0]) - _FAR, max(a[0], b[0]) + _FAR
        apart, near = _FAR, a
        first = max(0, int(np.searchsorted(p[:, 0], low)) - 1)
        for i in range(first, len(p) - 1):
            if p[i, 0] > high:
                break
            gap = _segments_apart(a, b, p[i], p[i + 1])
            if gap < apart:
                apart, near = gap, p[i]
        inside = apart == 0.0 or a[1] < ground_height(p, a[0])
        if apart - r < best and not inside:
            best, at_x, at_z = apart - r, near[0], near[1]
        if inside:
            steps = max(1, int(math.hypot(b[0] - a[0], b[1] - a[1]) / _RASTER))
            for i in range(steps + 1):
                x = a[0] + (b[0] - a[0]) * i / steps
                z = a[1] + (b[1] - a[1]) * i / steps
                if z <= ground_height(p, x):
                    depth = distance_to_profile(p, x, z, _FAR)
                    if -depth - r < best:
                        best, at_x, at_z = -depth - r, x, z
    # A corner of the ground inside the trunk may be deeper than any side of the trunk.
    for i in range(len(p)):
        deep = _FAR
        for k in range(4):
            a, b = segments[k, 0], segments[k, 1]
            # The sides run anticlockwise: inside lies to their left.
            side = (b[0] - a[0]) * (p[i, 1] - a[1]) - (b[1] - a[1]) * (p[i, 0] - a[0])
            deep = min(deep, side / math.hypot(b[0] - a[0], b[1] - a[1]))
        if deep > 0.0 and -deep < best:
            best, at_x, at_z = -deep, p[i, 0], p[i, 1]
    return best, at_x, at_z
