"""An independent judge of poses: own kinematics from the contract's conventions, shapely geometry.

Nothing here is shared with the planner. Lengths in m, angles in rad.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from shapely.geometry import LineString, Point, Polygon


@dataclass(frozen=True)
class Verdict:
    wheel_gap: float  # largest distance of a rim from the terrain, either way
    clearance: float  # least signed distance of trunk and links from the terrain
    edge_cut: float  # deepest penetration of trunk or link axes (no radii)
    joint_slack: float  # least distance of a joint from its limits
    legs_apart: float  # least distance of the front leg's bodies from the rear leg's
    closure: float  # largest distance between wheel centres stated and by kinematics


def _turn(angle: float, x: float, z: float) -> np.ndarray:
    """A trunk vector in the world: rotation about +y, which takes x towards -z."""
    return np.array(
        [math.cos(angle) * x + math.sin(angle) * z, -math.sin(angle) * x + math.cos(angle) * z]
    )


def skeleton(robot: Any, x: float, z: float, pitch: float, q: Any) -> dict[str, Any]:
    trunk = np.array([x, z])
    out: dict[str, Any] = {}
    length, height = robot.trunk.size[0] / 2, robot.trunk.size[2] / 2
    out["trunk"] = Polygon(
        [
            trunk + _turn(pitch, a * length, b * height)
            for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1))
        ]
    )
    for k, (name, hip) in enumerate((("front", robot.hips.front), ("rear", robot.hips.rear))):
        h = trunk + _turn(pitch, *hip)
        knee = h + _turn(pitch + q[2 * k], 0.0, -robot.thigh.length)
        wheel = knee + _turn(pitch + q[2 * k] + q[2 * k + 1], 0.0, -robot.calf.length)
        out[name] = (h, knee, wheel)
    return out


def run_out(vertices: np.ndarray) -> np.ndarray:
    """The profile (n, 2) with a metre of level ground beyond either end."""
    beyond = np.array([1.0, 0.0])
    return np.vstack([vertices[0] - beyond, vertices, vertices[-1] + beyond])


def ground(vertices: np.ndarray) -> tuple[Polygon, LineString]:
    """The solid below the profile, which goes on level beyond its ends, and its surface."""
    vertices = run_out(vertices)
    low = vertices[:, 1].min() - 5.0
    first, last = vertices[0], vertices[-1]
    solid = Polygon([*map(tuple, vertices), (last[0], low), (first[0], low)])
    return solid.buffer(0), LineString(vertices)


def _depth(body: Any, solid: Polygon, line: LineString) -> float:
    """Signed: distance where apart, minus the deepest point inside where not."""
    if not body.intersects(solid):
        return float(body.distance(solid))
    inside = body.intersection(solid)
    points = shapely.points(shapely.get_coordinates(shapely.segmentize(inside, 1e-3)))
    return -float(np.max(shapely.distance(points, line), initial=0.0))


def check(
    robot: Any, vertices: np.ndarray, x: float, z: float, pitch: float, q: Any, wheels: Any = None
) -> Verdict:
    solid, line = ground(vertices)
    bones = skeleton(robot, x, z, pitch, q)
    gaps, clear, cuts, closure = [], [], [], 0.0
    depth = _depth(bones["trunk"], solid, line)
    # A corner of the ground inside the trunk is as deep as its distance from the trunk's sides.
    for vertex in vertices:
        if bones["trunk"].contains(Point(vertex)):
            depth = min(depth, -float(bones["trunk"].exterior.distance(Point(vertex))))
    clear.append(depth)
    cuts.append(-depth)
    legs = []
    for k, name in enumerate(("front", "rear")):
        hip, knee, wheel = bones[name]
        centre = Point(wheel)
        away = line.distance(centre) * (-1.0 if solid.contains(centre) else 1.0)
        gaps.append(abs(away - robot.wheel.radius))
        if wheels is not None:
            closure = max(closure, float(np.hypot(*(np.asarray(wheels[k]) - wheel))))
        parts = []
        for a, b, radius in (
            (hip, knee, robot.thigh.radius),
            (knee, wheel, robot.calf.radius),
        ):
            bone = LineString([a, b])
            depth = _depth(bone, solid, line)
            clear.append(depth - radius)
            cuts.append(-depth)
            parts.append((bone, radius))
        parts.append((centre, robot.wheel.radius))
        legs.append(parts)
    apart = min(a.distance(b) - r1 - r2 for a, r1 in legs[0] for b, r2 in legs[1])
    limits = [
        robot.joints.front.thigh,
        robot.joints.front.calf,
        robot.joints.rear.thigh,
        robot.joints.rear.calf,
    ]
    slack = min(min(a - low, high - a) for a, (low, high) in zip(q, limits, strict=True))
    return Verdict(max(gaps), min(clear), max(0.0, *cuts), slack, apart, closure)


def check_pose(robot: Any, vertices: np.ndarray, pose: Any) -> Verdict:
    return check(robot, vertices, pose.x_c, pose.z_c, pose.pitch, pose.q, pose.wheels)
