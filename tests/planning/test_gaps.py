"""The certificate's distances against shapely's over the whole profile, one sample at a time."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import shapely

import stairwright as sw
from stairwright.planning.gaps import Gaps
from stairwright.planning.motion import Motion, Samples, sampled
from stairwright.terrain.profile import Terrain


def profile(seed):
    """Steps, ramps and flats, without a place where a wheel could not roll."""
    rng = np.random.default_rng(seed)
    points = [(0.0, 0.0), (1.5, 0.0)]
    for _ in range(6):
        x, z = points[-1]
        rise = rng.uniform(-0.1, 0.1)
        points += [(x + rng.choice([0.0, 0.1]), z + rise), (x + rng.uniform(0.25, 0.5), z + rise)]
    points.append((points[-1][0] + 1.5, points[-1][1]))
    return Terrain.model_validate({"schema": "stairwright/terrain/1", "points": points})


def motions():
    """Of certified plans, and of plans shaken until links are in the ground and legs cross."""
    for seed in range(3):
        plan = sw.plan(profile(seed), "a1_wheeled", 0.7)
        assert plan.poses
        motion = Motion.of(plan)
        yield sampled(motion)
        rng = np.random.default_rng(seed)
        body = motion.body + rng.normal(0.0, (0.03, 0.03, 0.1), motion.body.shape)
        joints = motion.joints + rng.normal(0.0, 0.3, motion.joints.shape)
        yield Samples(replace(motion, body=body, joints=joints))


@pytest.fixture(scope="module")
def all_samples():
    return list(motions())


def same_where_it_matters(found, exact, slack):
    """Exact at the least and wherever less than the slack; elsewhere never more than is true."""
    assert np.min(found - slack) == pytest.approx(np.min(exact - slack), abs=1e-12)
    matters = (exact < slack) | (found < slack)
    assert found[matters] == pytest.approx(exact[matters], abs=1e-12)
    assert (found <= exact + 1e-12).all()


def signed(line, shape, ground, point):
    """Distance from the ground; -1 where the point is below it."""
    return shapely.distance(line, shape) if point[1] > ground(point[0]) else -1.0


def test_clearances(all_samples):
    spared = 0
    for samples in all_samples:
        motion, frames = samples.motion, samples.frames
        line = shapely.linestrings(motion.vertices)
        robot = motion.robot

        def ground(x, points=motion.vertices):
            return np.interp(x, *points.T)

        links = np.full(len(samples.slack), np.inf)
        for k, leg in product(range(len(links)), range(2)):
            hip, knee, wheel = (f[k, leg] for f in (frames.hips, frames.knees, frames.wheels))
            for a, b, link in ((hip, knee, robot.thigh), (knee, wheel, robot.calf)):
                distance = signed(line, shapely.linestrings([a, b]), ground, a)
                links[k] = min(links[k], distance - link.radius)
        found = Gaps(samples).links()
        same_where_it_matters(found, links, samples.slack)
        spared += int((found < links - 1e-9).sum())
        trunk = np.empty(len(links))
        half = np.array([robot.trunk.size[0], robot.trunk.size[2]]) / 2
        for k, (x, z, pitch) in enumerate(motion.body):
            c, s = np.cos(pitch), np.sin(pitch)
            corners = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]]) * half
            box = shapely.polygons([x, z] + corners @ np.array([[c, -s], [s, c]]))
            trunk[k] = signed(line, box, ground, (x, z))
        same_where_it_matters(Gaps(samples).trunk(), trunk, samples.slack)
    assert spared > 1000  # or the bounds spare no work, and are not tested here


def test_gap_between_legs(all_samples):
    spared, crossed = 0, 0
    for samples in all_samples:
        robot, f = samples.motion.robot, samples.frames
        radii = (robot.thigh.radius, robot.calf.radius, robot.wheel.radius)
        exact = np.empty(len(samples.slack))
        for k in range(len(exact)):
            legs = [
                [
                    shapely.linestrings([f.hips[k, leg], f.knees[k, leg]]),
                    shapely.linestrings([f.knees[k, leg], f.wheels[k, leg]]),
                    shapely.points(f.wheels[k, leg]),
                ]
                for leg in range(2)
            ]
            exact[k] = min(
                shapely.distance(a, b) - ra - rb
                for (a, ra), (b, rb) in product(
                    zip(legs[0], radii, strict=True), zip(legs[1], radii, strict=True)
                )
            )
        found = Gaps(samples).legs()
        assert found.min() == pytest.approx(exact.min(), abs=1e-12)
        assert (found <= exact + 1e-12).all()
        spared += int((found < exact - 1e-9).sum())
        crossed += bool(exact.min() < 0.0)
    assert spared > 500
    assert crossed
