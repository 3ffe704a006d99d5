"""The certificate's distances against shapely's over the whole profile, one sample at a time."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import shapely

import stairwright as sw
from stairwright import _core
from stairwright.library import load_robot
from stairwright.planning.certificate.certify import judge
from stairwright.planning.certificate.equilibrium import near_faces
from stairwright.planning.certificate.motion import Motion, Samples, sampled
from stairwright.robot import kinematics as kin
from stairwright.terrain.profile import Terrain, height_at
from tests.robot.random_robots import random_robot
from tests.shapely_checker import run_out


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


def ground_of(samples):
    return _core.CertificateGround(samples.motion.vertices)


def links_of(samples):
    return samples.postures.links(ground_of(samples), samples.slack)


def trunk(samples):
    return samples.postures.trunk(ground_of(samples), samples.slack)


def motions():
    """Of certified plans, and what of them is lowered, shaken, or carried past the ends."""
    for seed in range(3):
        plan = sw.plan(profile(seed), "a1_wheeled", 0.7)
        assert plan.poses
        motion = Motion.of(plan)
        yield sampled(motion)
        rng = np.random.default_rng(seed)
        body = motion.body + rng.normal(0.0, (0.03, 0.03, 0.1), motion.body.shape)
        joints = motion.joints + rng.normal(0.0, 0.3, motion.joints.shape)
        yield Samples(replace(motion, body=body, joints=joints))
        least = trunk(sampled(motion)).min()
        for x, z in ((0.0, -0.5), (-1.6, -0.4), (2.0, 0.05), (0.0, 2e-4 - least)):
            yield sampled(replace(motion, body=motion.body + np.array([x, z, 0.0])))


@pytest.fixture(scope="module")
def all_samples():
    return list(motions())


def same_where_it_matters(found, exact, slack):
    """Exact at the least and wherever less than the slack; elsewhere never more than is true."""
    assert np.min(found - slack) == pytest.approx(np.min(exact - slack), abs=1e-12)
    matters = (exact < slack) | (found < slack)
    assert found[matters] == pytest.approx(exact[matters], abs=1e-12)
    assert (found <= exact + 1e-12).all()


def above(motion, point):
    """Whether a point (2,) lies above the ground, or beyond its ends."""
    x = motion.vertices[:, 0]
    return not x[0] <= point[0] <= x[-1] or point[1] > height_at(motion.vertices, point[:1])[0]


def signed(motion, shape, point):
    """Distance from the ground; -1 where the point is below it."""
    return shapely.distance(motion.line, shape) if above(motion, point) else -1.0


class WithLine:
    """A motion and its ground for shapely."""

    def __init__(self, motion):
        self.vertices, self.robot, self.body = run_out(motion.vertices), motion.robot, motion.body
        self.line = shapely.linestrings(self.vertices)


@pytest.mark.slow
def test_links(all_samples):
    spared = unsettled = 0
    for samples in all_samples:
        motion, frames, slack = WithLine(samples.motion), samples.frames, samples.slack
        exact = np.full(len(slack), np.inf)
        for k, leg in product(range(len(exact)), range(2)):
            hip, knee, wheel = (f[k, leg] for f in (frames.hips, frames.knees, frames.wheels))
            for a, b, link in (
                (hip, knee, motion.robot.thigh),
                (knee, wheel, motion.robot.calf),
            ):
                distance = signed(motion, shapely.linestrings([a, b]), a)
                exact[k] = min(exact[k], distance - link.radius)
        found = links_of(samples)
        same_where_it_matters(found, exact, slack)
        spared += int((found < exact - 1e-9).sum())
        unsettled += int(((exact > 0.0) & (exact < slack)).sum())
    assert spared > 1000  # or the bounds spare no work, and are not tested here
    assert unsettled


def test_trunk(all_samples):
    spared = unsettled = sunk = 0
    for samples in all_samples:
        motion, slack = WithLine(samples.motion), samples.slack
        exact = np.empty(len(slack))
        half = np.array([motion.robot.trunk.size[0], motion.robot.trunk.size[2]]) / 2
        for k, (x, z, pitch) in enumerate(motion.body):
            c, s = np.cos(pitch), np.sin(pitch)
            corners = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]]) * half
            box = shapely.polygons([x, z] + corners @ np.array([[c, -s], [s, c]]))
            exact[k] = signed(motion, box, motion.body[k, :2])
        found = trunk(samples)
        same_where_it_matters(found, exact, slack)
        spared += int((found < exact - 1e-9).sum())
        unsettled += int(((exact > 0.0) & (exact < slack)).sum())
        sunk += int((exact == -1.0).sum())
    assert spared > 1000
    assert unsettled
    assert sunk


@pytest.mark.slow
def test_rims(all_samples):
    sunk = seen = 0
    for samples in all_samples:
        motion = WithLine(samples.motion)
        centres = samples.frames.wheels.reshape(-1, 2)
        ground, radius = ground_of(samples), motion.robot.wheel.radius
        near = near_faces(ground, centres, radius + 0.002).distances[:, 0].reshape(-1, 2)
        for leg in range(2):
            found = samples.postures.rims(leg, ground) + radius
            for k, centre in enumerate(samples.frames.wheels[:, leg]):
                distance = shapely.distance(motion.line, shapely.points(centre))
                sunk += (below := not above(motion, centre))
                assert found[k] == pytest.approx(-distance if below else distance)
            seen += int((k := np.isfinite(near[:, leg])).sum())
            assert near[k, leg] == pytest.approx(np.abs(found)[k])
    assert sunk
    assert seen > 1000


@pytest.mark.slow
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
        found = samples.postures.between_legs()
        assert found.min() == pytest.approx(exact.min(), abs=1e-12)
        assert (found <= exact + 1e-12).all()
        spared += int((found < exact - 1e-9).sum())
        crossed += bool(exact.min() < 0.0)
    assert spared > 500
    assert crossed


def placed(robot, frames, k):
    """Axes and radii of all capsules of links, and the first end of each, at sample k."""
    for leg, own in enumerate(robot.legs):
        hip, knee, wheel = (f[k, leg] for f in (frames.hips, frames.knees, frames.wheels))
        for link, upper, lower in ((own.thigh, hip, knee), (own.calf, knee, wheel)):
            dx, dz = (lower - upper) / link.length
            turn = np.array([[-dz, -dx], [dx, -dz]])  # columns: ahead, and up from the lower joint
            for begin, end, radius in link.capsules:
                axis = upper + np.array([begin, end]) @ turn.T
                yield axis, radius


def test_any_robot_and_its_kinematics():
    """Robots with outlines of several pieces, bent links and legs of two kinds, in any posture."""
    rng = np.random.default_rng(5)
    vertices = profile(1).vertices
    robots = [load_robot(name) for name in ("go2w", "anymal_wheels")]
    robots += [random_robot(seed) for seed in range(6)]
    several = bounded = 0
    for robot in robots:
        ends = rng.uniform((0.5, 0.2, -0.4), (3.0, 0.8, 0.4), (4, 3))
        share = np.linspace(0.0, 3.0, 61)
        body = np.stack([np.interp(share, range(4), each) for each in ends.T], axis=1)
        angles = rng.uniform(*kin.limits(robot).T, (4, 4))
        joints = np.stack([np.interp(share, range(4), each) for each in angles.T], axis=1)
        motion = Motion(vertices, robot, 0.6, body, joints, share)
        samples, line = Samples(motion), WithLine(motion)
        frames = kin.forward(robot, *body.T, joints)
        for points in ("hips", "knees", "wheels"):
            own, reference = (getattr(each, points) for each in (samples.frames, frames))
            assert own == pytest.approx(reference, abs=1e-12)
        assert samples.com == pytest.approx(kin.com(robot, *body.T, frames), abs=1e-12)

        trunks, links = np.empty(len(body)), np.empty(len(body))
        for k, pitch in enumerate(body[:, 2]):
            pieces = [np.array(piece.points) for piece in robot.body.outline]
            turned = [body[k, :2] + kin.rotate(pitch, piece) for piece in pieces]
            trunks[k] = min(signed(line, shapely.polygons(p), p.mean(axis=0)) for p in turned)
            links[k] = min(
                signed(line, shapely.linestrings(axis), axis[0]) - radius
                for axis, radius in placed(robot, frames, k)
            )
        several += len(turned) > 1
        for find, exact in ((trunk, trunks), (links_of, links)):
            found = find(samples)
            same_where_it_matters(found, exact, samples.slack)
            bounded += int((found < exact - 1e-9).sum())
    assert several
    assert bounded > 50


def test_ground_all_inside_the_trunk_is_no_clearance():
    speck = np.array([[-0.01, 0.0], [0.01, 0.0]])
    body, joints = np.array([[0.0, 0.005, 0.0]]), np.zeros((1, 4))
    motion = Motion(speck, load_robot("a1_wheeled"), 0.6, body, joints, np.zeros(1))
    assert trunk(Samples(motion)) == 0.0


def test_a_robot_far_beyond_the_profile_fails_without_an_error():
    plan = sw.plan("curb-015", "a1_wheeled")
    motion = Motion.of(plan)
    for x in (-50.0, 50.0):
        away = judge(replace(motion, body=motion.body + np.array([x, 0.0, 0.0])))
        failed = {check.name for check in away.checks if not check.passed}
        assert {"gap between wheels and ground", "samples out of balance"} <= failed
