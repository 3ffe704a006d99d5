"""The certificate of a tolerance: bounds that hold for whole sets of terrains, tried by members."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import shapely
from scipy.optimize import linprog

import stairwright as sw
from stairwright import _core
from stairwright.planning.certificate.certify import TOUCH, tolerated
from stairwright.planning.certificate.motion import Motion, Samples
from stairwright.planning.certificate.tolerance.checks import NAMES, ToleranceCheck
from stairwright.planning.certificate.tolerance.ground import VariedGround
from stairwright.planning.plan import Plan
from stairwright.planning.tolerance import Tolerance
from stairwright.robot import kinematics as kin
from stairwright.simulation.disturbance import Disturbance
from stairwright.simulation.world import real_terrain

Floats = np.ndarray
STAIRS = {
    "name": "two steps",
    "points": [[-1.2, 0], [0, 0], [0, 0.16], [0.3, 0.16], [0.3, 0.32], [1.6, 0.32]],
}
TOLERANCE = Tolerance(height=0.01, place=0.01, friction=0.1)


@pytest.fixture(scope="module")
def plan() -> Plan:
    found = sw.plan(STAIRS, "go2w", friction=0.6, tolerance=TOLERANCE)
    assert found.feasible, found.problem
    return found


def checked(plan: Plan) -> ToleranceCheck:
    """The checks at the poses alone."""
    samples = Samples(Motion.of(plan))

    def second(_: Samples) -> Floats:
        return np.full((len(plan.poses), 2), plan.robot_description.wheel.radius + TOUCH)

    return ToleranceCheck(samples, TOLERANCE, second)


def errors(random: np.random.Generator) -> tuple[Floats, Floats]:
    """Errors of two steps [m] and of two faces [m]: often at their limits."""
    drawn = random.uniform(-1.0, 1.0, (2, 2))
    drawn = np.where(random.random((2, 2)) < 0.7, np.sign(drawn), drawn)
    return TOLERANCE.height * drawn[0], TOLERANCE.place * drawn[1]


@pytest.mark.slow
def test_no_terrain_of_the_set_leaves_less_than_the_bounds(plan: Plan) -> None:
    check = checked(plan)
    samples, stands = check.samples, check.stands
    motion, robot = samples.motion, samples.motion.robot
    told = {
        "trunk": check._trunk(), "links": check._links(), "legs": check._between_legs(),
        "joints": check._joint_slack(),
    }  # fmt: skip
    random = np.random.default_rng(1)
    nearest = dict.fromkeys(told, np.inf)
    for _ in range(400):
        k = int(random.integers(len(plan.poses)))
        steps, faces = errors(random)
        deviation = Disturbance(step_height_error=steps.tolist(), face_place_error=faces.tolist())
        real = real_terrain(plan.terrain, deviation, 0).vertices
        level, place = np.append(0.0, np.cumsum(steps)), np.append(0.0, faces)
        ground = [
            np.array([place[max(footing.faces, default=0)], level[footing.low]])
            for footing in (stands._footing(pair, k) for pair in range(2))
        ]
        wheels = samples.frames.wheels[k] + ground
        clear = shapely.distance(shapely.linestrings(real), shapely.points(wheels))
        if clear.min() < robot.wheel.radius - 1e-3:
            continue  # the wheel would have met that face before
        share = random.uniform(*stands.shares[k])
        body = motion.body[k].copy()
        body[:2] += share * ground[0] + (1.0 - share) * ground[1]
        q = kin.inverse(robot, *body, wheels)
        low, high = kin.limits(robot).T
        one = Motion(real, robot, motion.friction, body[None], q[None], np.zeros(1))
        postures, ground_there = Samples(one).postures, _core.CertificateGround(real)
        true = {
            "trunk": postures.trunk(ground_there, np.zeros(1))[0],
            "links": postures.links(ground_there, np.zeros(1))[0],
            "legs": postures.between_legs()[0], "joints": np.minimum(q - low, high - q).min(),
        }  # fmt: skip
        for what, value in true.items():
            assert value >= told[what][k] - 1e-6, (what, k)
            nearest[what] = min(nearest[what], value - told[what][k])
    # The bounds are no looser than they need be.
    assert max(nearest.values()) < 0.01, nearest


@pytest.mark.slow
def test_forces_balance_the_robot_on_every_terrain_of_the_set(plan: Plan) -> None:
    check = checked(plan)
    stands, contacts = check.stands, check.holding.firm
    room = check.holding.com_margin()
    random = np.random.default_rng(2)
    assert room.min() >= 0.0
    for k in random.integers(len(plan.poses), size=150):
        apart = stands.apart[k] * random.choice([-1.0, 1.0], 2) * random.random(2) ** 0.3
        share = random.uniform(*stands.shares[k])
        moved = np.where(contacts.front[:, None], (1.0 - share) * apart, -share * apart)
        rays = contacts.rays[k].copy()
        rays[:, 2] += moved[:, 0] * rays[:, 1] - moved[:, 1] * rays[:, 0]
        shift = check.holding._com_shift[k]
        held = [
            linprog(
                np.zeros(len(rays)), A_eq=rays.T, b_eq=[0.0, 1.0, com], bounds=(0, None)
            ).status == 0
            for com in (-shift, shift)
        ]  # fmt: skip
        assert all(held), k


def worse(plan: Plan, **change: Any) -> set[str]:
    """Names of the tolerance's checks that a changed plan fails; `certify` refuses it."""
    changed = plan.model_copy(update=change)
    certificate = sw.certify(changed)
    assert not certificate.passed
    return {c.name for c in certificate.checks if not c.passed} & set(NAMES.values())


@pytest.mark.slow
def test_the_certificate_of_a_plan_is_that_of_its_document(plan: Plan) -> None:
    certificate = sw.certify(plan)
    assert certificate.passed
    assert certificate == plan.certificate
    assert [c.name for c in certificate.checks][-len(NAMES) :] == list(NAMES.values())


@pytest.mark.slow
def test_more_than_was_planned_for_is_refused(plan: Plan) -> None:
    assert worse(plan, tolerance=Tolerance(height=0.05, place=0.05))
    assert NAMES["com"] in worse(plan, tolerance=Tolerance(friction=0.45))


@pytest.mark.slow
def test_a_pose_that_uses_up_the_room_is_refused(plan: Plan) -> None:
    # Where legs have least to spare the trunk is raised: drawn ground it stands, other ground not.
    robot, poses = plan.robot_description, list(plan.poses)
    middle = int(np.argmin(checked(plan)._joint_slack()))
    for k in range(max(1, middle - 12), min(len(poses) - 1, middle + 13)):
        pose = poses[k]
        up = 0.012 * (1.0 - abs(k - middle) / 13)
        q = kin.inverse(robot, pose.x_c, pose.z_c + up, pose.pitch, np.array(pose.wheels))
        poses[k] = pose.model_copy(update={"z_c": pose.z_c + up, "q": tuple(q.tolist())})
    assert worse(plan, poses=poses) == {NAMES["joints"]}
    assert sw.certify(plan.model_copy(update={"poses": poses, "tolerance": None})).passed


def test_a_plan_without_a_tolerance_stands_less() -> None:
    usual = sw.plan(STAIRS, "go2w", friction=0.6)
    checks = tolerated(Motion.of(usual), TOLERANCE)
    assert not all(check.passed for check in checks)


def test_what_a_wheel_touches_is_where_it_is() -> None:
    ground = VariedGround(np.array(STAIRS["points"], float), place=0.02, height=0.01)
    on_tread = ground.footing(np.array([False, False, True, False, False]), 4)
    assert (on_tread.low, on_tread.high, on_tread.faces) == (1, 1, frozenset({1}))
    least, most = ground.off(on_tread)
    # Of its own tread the height, and the face behind it, are as drawn; what is ahead is not.
    assert most[:, 1] == pytest.approx([0.01, 0.01, 0.0, 0.0, 0.01, 0.01])
    assert most[:, 0] == pytest.approx([0.02, 0.0, 0.0, 0.04, 0.04, 0.02])
    assert least[3:5, 0] == pytest.approx([-0.04, -0.04])
    near = ground.footing(np.array([False, False, True, False, False]), 1)
    assert ground.off(near)[0][3:5, 0] == pytest.approx([-0.01, -0.01])
    corner = ground.footing(np.array([True, True, False, False, False]), 4)
    assert ground.apart(on_tread, corner) == pytest.approx([0.0, 0.01])
