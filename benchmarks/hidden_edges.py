"""How often do 25 clear collision points hide a link or a trunk that cuts an edge?

Draws random poses with both wheels exactly on random profiles and all joints inside their limits
(inverse kinematics of random trunks), keeps those whose collision points all lie above the ground,
and measures how deep trunk and link axes reach into the ground (shapely, link radii left out).

    python benchmarks/hidden_edges.py [--poses 20000] [--seed 0] [--robot a1_wheeled]
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import stairwright as sw
from stairwright.robot import kinematics
from stairwright.terrain.profile import Terrain, height_at
from stairwright.terrain.stairs import ramp, stair
from stairwright.terrain.wheel_path import wheel_path
from tests.planning.drawn import random_profile
from tests.shapely_checker import check

DEPTHS = (0.001, 0.002, 0.005, 0.010, 0.020)  # m


def terrain(random: np.random.Generator) -> Terrain:
    kind = random.integers(4)
    if kind == 0:
        return stair(random.uniform(0.05, 0.42))
    if kind == 1:
        return stair(random.uniform(0.06, 0.20), random.uniform(0.22, 0.40), 3)
    if kind == 2:
        return ramp(random.uniform(0.1, 0.4), random.uniform(0.17, 0.8))
    return random_profile(int(random.integers(1 << 30)))


def poses(robot, ground, random, count):
    """Random trunks (n, 3) and joints (n, 4) with the wheels on the ground, limits kept."""
    path = wheel_path(ground, robot.wheel.radius)
    front = random.uniform(0.6, path.length - 0.3, count)
    rear = front - random.uniform(0.12, 0.65, count)
    wheels = path.centres(np.concatenate([front, rear])).reshape(2, count, 2).transpose(1, 0, 2)
    middle = wheels.mean(axis=1)
    line = wheels[:, 0] - wheels[:, 1]
    x = middle[:, 0] + random.normal(0, 0.08, count)
    z = middle[:, 1] + random.uniform(0.05, 0.30, count)
    pitch = -np.arctan2(line[:, 1], line[:, 0]) + random.normal(0, 0.3, count)
    q = kinematics.inverse(robot, x, z, pitch, wheels)
    low, high = kinematics.limits(robot).T
    valid = np.all((q >= low) & (q <= high), axis=1)
    trunk = np.stack([x, z, pitch], axis=1)[valid]
    points = kinematics.collision_points(robot, *trunk.T, q[valid])
    height = height_at(ground.vertices, points[..., 0].ravel()).reshape(points.shape[:2])
    clear = np.all(points[..., 1] > height, axis=1)
    return trunk[clear], q[valid][clear], int(valid.sum())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--poses", type=int, default=20_000, help="clear poses to judge")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--robot", default="a1_wheeled", choices=sw.robots())
    arguments = parser.parse_args()
    robot, random = sw.load_robot(arguments.robot), np.random.default_rng(arguments.seed)
    cuts, touches, tried = [], 0, 0
    while len(cuts) < arguments.poses:
        ground = terrain(random)
        trunks, joints, valid = poses(robot, ground, random, 400)
        tried += valid
        for trunk, q in zip(trunks, joints, strict=True):
            verdict = check(robot, ground.vertices, *trunk, q)
            cuts.append(verdict.edge_cut)
            touches += verdict.clearance < 0
    depth = np.array(cuts)
    print(f"{arguments.robot}: {tried} valid poses, {len(depth)} with all points clear")
    for limit in DEPTHS:
        print(
            f"  cut deeper than {limit * 1e3:2.0f} mm by a link axis or the trunk: "
            f"{np.mean(depth > limit):.2%}"
        )
    print(f"  deepest cut {depth.max() * 1e3:.0f} mm")
    print(f"  trunk or a link with its radius touches the ground: {touches / len(depth):.2%}")


if __name__ == "__main__":
    main()
