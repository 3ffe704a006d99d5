"""Motors that are weak for the robot's weight: the search looks for poses that they hold."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stairwright as sw
from stairwright.planning.attempt import Blocked, Solved
from stairwright.planning.infeasibility.relaxation import motor_torque
from stairwright.planning.path_planner import PathPlanner, path_planner
from stairwright.planning.smoothing.node_margins import BEYOND_REPAIR, FIRM_TORQUE
from stairwright.planning.static_torques import static_torques
from stairwright.planning.strategy import AT_ONCE, HEAVY, solve
from stairwright.planning.threads import in_this_thread
from stairwright.planning.weights import PathWeights
from stairwright.terrain.generation import StairParameters, generate

STEP = {"points": [[-2.0, 0.0], [0.0, 0.0], [0.0, 0.1], [2.5, 0.1]]}


@pytest.mark.slow
def test_a_heavy_robot_climbs_where_its_legs_are_not_level():
    """A static search by brute force finds postures under 31 Nm here; level ones need 123 Nm."""
    plan = sw.plan(STEP, "anymal_wheels", 0.6)
    assert plan.feasible
    robot = plan.robot_description
    trunk = np.array([(pose.x_c, pose.z_c, pose.pitch) for pose in plan.poses])
    q, contacts, forces = (
        np.array([getattr(pose, name) for pose in plan.poses])
        for name in ("q", "contacts", "forces")
    )
    torques = np.abs(static_torques(robot, trunk, q, contacts, forces)).reshape(-1, 4, 3)
    assert torques[:, :, :2].max() < 80.0
    assert min(pose.margins.torque for pose in plan.poses) > 0.05 * 80.0
    assert sw.rollout(plan).outcome == "success"


def test_a_path_under_a_looser_limit_is_not_lost_under_a_tighter_one_that_it_keeps():
    data = sw.load_robot("anymal_wheels").model_dump()
    feasible = []
    for torque in (200.0, 130.0, 100.0, 80.0):
        for part in ("thigh", "calf"):
            data["actuators"][part]["torque"] = torque
        feasible.append(sw.plan(STEP, data, 0.9).feasible)
    assert feasible == [True] * 4


@pytest.mark.slow
def test_another_lattice_is_tried_where_paths_within_torques_overload_motors():
    """Refused for a torque until then, like a sixth of such refusals."""
    data = sw.load_robot("b2w").model_dump()
    for name, share in (("thigh", 0.68), ("calf", 0.68), ("wheel", 0.43)):
        data["actuators"][name] |= {"continuous": None}
        data["actuators"][name]["torque"] *= share
    down = StairParameters(kind="stair", rise=0.15, run=0.35, count=2, direction="down")
    plan = sw.plan(generate(down), data)
    assert plan.feasible
    assert sw.rollout(plan).outcome == "success"


@pytest.mark.slow
def test_the_torque_that_is_named_is_enough_and_little_less_is_not():
    """Of legs, whose motors differ; `test_path.py` asks about wheels, too."""
    data = sw.load_robot("b2w").model_dump()
    weak, names = 0.15, ("thigh", "calf")
    for name in names:
        data["actuators"][name]["torque"] *= weak
    limit = sw.plan("single-stair-036", data).problem.limit
    assert limit.quantity == "leg torque"
    ratio = limit.needed / limit.available
    assert limit.confirmed == pytest.approx((limit.needed / 1.02, limit.needed))
    feasible = []
    for share in (1.02, 1.0, 1.0 / 1.02):
        changed = sw.load_robot("b2w").model_dump()
        for name in names:
            changed["actuators"][name]["torque"] *= weak * ratio * share
        feasible.append(sw.plan("single-stair-036", changed, diagnose=False).feasible)
    assert feasible == [True, True, False]
    assert data["actuators"]["calf"]["torque"] < limit.needed


@pytest.mark.slow
def test_a_search_within_torques_leads_where_motors_have_most_to_spare():
    """Few of the paths that 9 Nm legs hold are smoothed into one that leaves them a reserve."""
    data = sw.load_robot("a1_wheeled").model_dump()
    data["actuators"]["leg"]["torque"] = 9.0
    plan = sw.plan("single-stair-036", data)
    assert plan.feasible
    # By its own sensors its legs, 5 mm apart in the end, touch: this is about torques.
    assert sw.rollout(plan, controller={"sensing": "ideal"}).outcome == "success"


@pytest.mark.slow
def test_what_overloads_motors_is_repaired_where_no_path_within_torques_is_found():
    flight = StairParameters(kind="stair", rise=0.16, run=0.22, count=3)
    terrain, robot = generate(flight), sw.load_robot("go2w")

    def planner():
        return path_planner(terrain, robot, 0.35, PathWeights())

    usual = planner()
    first = usual.attempt(AT_ONCE)
    assert isinstance(first, Blocked)
    assert first.weak == "leg"
    found = solve(usual, in_this_thread())
    assert isinstance(found, Solved)
    assert found is usual.within_torques.attempt(AT_ONCE)

    slippery = planner()
    slippery.within_torques = replace(slippery.within_torques, friction=0.01)
    found = solve(slippery, in_this_thread())
    assert isinstance(found, Solved)
    assert found.certificate.passed
    assert HEAVY < found.torque_share <= FIRM_TORQUE


def weakened(name: str, share: float) -> PathPlanner:
    """The question of `STEP` for a robot with a share of its legs' torque."""
    planner = path_planner(sw.load_terrain(STEP), sw.load_robot(name), 0.6, PathWeights())
    motors = motor_torque(planner.robot, "leg")
    return motors.change(planner, motors.available * share)


def test_what_is_beyond_repair_is_not_looked_at_again_and_would_stay_as_it_is():
    planner = weakened("a1_wheeled", 0.2)
    end = planner.attempt(AT_ONCE)
    assert isinstance(end, Blocked)
    assert end.share > FIRM_TORQUE + BEYOND_REPAIR
    assert planner.repairing_all.attempt(AT_ONCE) is end
    anew = replace(planner, thorough=True).attempt(AT_ONCE)
    assert isinstance(anew, Blocked)
    assert (anew.reached, anew.share) == (end.reached, end.share)


@pytest.mark.slow
def test_knees_that_bend_both_ways_lack_the_least_that_any_bend_lacks():
    """Both back, with which the robot comes farthest, it takes 37 Nm."""

    def weak(torque):
        robot = sw.load_robot("m20").model_dump(mode="json")
        for joint in ("thigh", "calf"):
            robot["actuators"][joint]["torque"] = torque
        return robot

    stair = {"points": [[-1.5, 0.0], [0.0, 0.0], [0.0, 0.3], [2.0, 0.3]]}
    limit = sw.plan(stair, weak(12.2), 0.6).problem.limit
    assert limit.quantity == "leg torque"
    too_weak, enough = limit.confirmed
    assert enough < 25.0
    assert not sw.plan(stair, weak(too_weak), 0.6, diagnose=False).feasible
    assert sw.plan(stair, weak(enough), 0.6, diagnose=False).feasible
