"""The robot senses by itself: where its wheels are, what they feel, how honest the filter is."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest

import stairwright as sw
from stairwright import _core
from stairwright._core import GRAVITY
from stairwright.control.settings import parse_settings
from stairwright.errors import InputError
from stairwright.planning.plan import Plan
from stairwright.robot.mujoco_model import build_model
from stairwright.simulation import plan_change
from stairwright.simulation.disturbance import Disturbance
from stairwright.simulation.result import Rollout
from stairwright.simulation.rollout import rollout
from stairwright.simulation.run import Run

STAIR = {"name": "stair", "points": [[-1.2, 0], [0, 0], [0, 0.2], [1.2, 0.2]], "friction": 0.6}
ROBOT = {"sensing": "robot"}
RADIUS = 0.05
NEES_95 = 12.59  # of chi squared with 6 degrees of freedom


OTHERS = [pytest.param(name, marks=pytest.mark.slow) for name in ("a1_wheeled_x", "go2w")]


@pytest.fixture(scope="module", params=["a1_wheeled", *OTHERS])
def plan(request: pytest.FixtureRequest) -> Plan:
    return sw.plan(STAIR, request.param)


def sensed(plan: Plan, seed: int = 0, **deviation: Any) -> tuple[Rollout, np.ndarray]:
    """A rollout by the robot's own sensors, and the filter's errors against the truth."""
    result, run = climbed(plan, seed, **deviation)
    assert run.native is not None
    return result, np.asarray(run.native.judged)


def climbed(plan: Plan, seed: int = 0, **deviation: Any) -> tuple[Rollout, Run]:
    settings = parse_settings(ROBOT)
    run = Run(plan, plan.friction, settings, Disturbance(**deviation), seed, 50.0)
    return run.result(run.simulate(None), keep_plan=False), run


@pytest.mark.slow
@pytest.mark.parametrize("start", [0.03, -0.03])
def test_climbs_by_its_own_sensors(plan: Plan, start: float) -> None:
    run, judged = sensed(plan, x_offset=start)
    assert run.outcome == "success", run.reason
    # The stair has told it where it is.
    assert np.abs(judged[-50:, 7]).max() < 0.02
    assert np.abs(judged[:, 2]).max() < 0.03


@pytest.mark.slow
@pytest.mark.parametrize(
    "deviation",
    [
        {"face_place_error": [0.03]},  # the plan waits, the wheels roll on until they feel it
        {"face_place_error": [-0.03]},
        {"step_height_error": [0.02]},
        {"step_height_error": [-0.02]},
        {"delay": 0.012},
    ],
)
def test_climbs_what_is_not_as_drawn(plan: Plan, deviation: dict[str, object]) -> None:
    run, _ = sensed(plan, **deviation)
    assert run.outcome == "success", run.reason


@pytest.mark.slow
def test_a_face_that_comes_early_calls_no_wheel_back() -> None:
    """Front wheels meet the third riser 6 cm early, against the last, while the rear ones climb."""
    plan = sw.plan("stairs-us-7-11", "a1_wheeled", 0.6)
    result, run = climbed(plan, face_place_error=[0.03, 0.03, -0.03, 0.03, 0.03])
    assert result.outcome == "success", result.reason
    assert run.change is not None
    drawn, found = plan.terrain.vertices, run.change.followed.terrain.vertices
    assert np.abs(found - drawn).max() > 0.05  # it has noticed


@pytest.mark.slow
def test_a_riser_that_is_felt_by_one_wheel_alone_is_put_right() -> None:
    """It went on as if its wheels could get there, and fell over backward."""
    plan = sw.plan("stairs-industrial", "a1_wheeled", 0.6)
    run, _ = sensed(plan, face_place_error=[0.03, 0.03, 0.03, -0.03])
    assert run.outcome == "success", run.reason


def _two_risers(name: str, rise: float, tread: float) -> Plan:
    points = [(-1.3, 0), (0, 0), (0, rise), (tread, rise), (tread, 0.12 + rise), (1.6, 0.12 + rise)]
    return sw.plan({"points": points}, name, 0.6)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "rise", "tread"), [("a1_wheeled", 0.10, 0.09), ("go2w", 0.12, 0.12)]
)
def test_a_riser_that_stops_wheels_on_the_edge_before_it_is_noticed(name, rise, tread) -> None:
    """They pushed, 6 cm before it was expected, until the robot fell over backward."""
    run, _ = sensed(_two_risers(name, rise, tread), face_place_error=[0.03, -0.03])
    assert run.outcome == "success", run.reason


@pytest.mark.slow
@pytest.mark.parametrize(("name", "drop"), [("b2w", 0.11), ("go2w", 0.08)])
def test_a_tread_below_that_is_met_on_the_edge_is_noticed(name, drop) -> None:
    """The filter had the wheels back up the edge, ever farther from where they were."""
    plan = sw.plan({"points": [(-1.5, 0), (0, 0), (0, -drop), (1.5, -drop)]}, name, 0.6)
    run, _ = sensed(plan, step_height_error=[0.02])
    assert run.outcome == "success", run.reason


@pytest.mark.slow
@pytest.mark.parametrize(("name", "drop", "tread"), [("b2w", 0.09, 0.35), ("go2w", 0.07, 0.40)])
def test_edges_down_that_are_lower_than_a_wheel_are_found(name, drop, tread) -> None:
    """Nothing but an arc leads from tread to tread; each edge is another one on the map, still."""
    points = [(-1.3, 0.0)]
    for step in range(3):
        points += [(step * tread, -step * drop), (step * tread, -(step + 1) * drop)]
    plan = sw.plan({"points": [*points, (3 * tread + 1.2, -3 * drop)]}, name, 0.6)
    run, judged = sensed(plan, face_place_error=[0.03, -0.03, 0.03])
    assert run.outcome == "success", run.reason
    assert np.abs(judged[:, 7]).max() < 0.035


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "top", "length", "lean", "errors"),
    [
        ("go2w", 0.12, 0.60, 0.07, [-0.02, 0.02]),  # a face that leans ends elsewhere on its line
        ("b2w", 0.10, 0.45, 0.0, [-0.02, -0.02]),  # a step lower than its wheels, twice
        ("b2w", 0.10, 0.45, 0.0, [0.02, 0.02]),  # no row of a whole plan is near to it
    ],
)
def test_a_box_that_is_not_as_high_as_drawn_is_crossed(name, top, length, lean, errors) -> None:
    points = [(-1.5, 0), (0, 0), (lean, top), (length, top), (length + lean, 0), (2.0, 0)]
    plan = sw.plan({"points": points}, name, 0.6)
    run, judged = sensed(plan, step_height_error=errors)
    assert run.outcome == "success", run.reason
    assert np.abs(judged[:, 7]).max() < 0.02


def test_where_no_plan_leads_on_from_there_it_stops(monkeypatch: pytest.MonkeyPatch) -> None:
    for planned in ("plan_anew", "plan_onward"):
        monkeypatch.setattr(plan_change, planned, lambda *_: None)
    run, _ = sensed(_two_risers("a1_wheeled", 0.10, 0.09), face_place_error=[0.03, -0.03])
    assert run.outcome == "stopped"
    assert "a riser stopped the front wheels" in run.reason


def test_legs_reach_for_ground_that_is_not_as_drawn(plan: Plan) -> None:
    """Front wheels on a step that is 2 cm lower: the trunk keeps its planned pitch."""
    run, judged = sensed(plan, step_height_error=[-0.02])
    front, rear = judged[:, 12], judged[:, 14]
    assert np.max(front - rear) == pytest.approx(0.02, abs=0.006)
    assert run.metrics.pitch_error_max < np.radians(5.0)


@pytest.mark.slow
def test_rear_wheels_know_what_front_wheels_found() -> None:
    """Climbing an edge that is not where it was drawn they would slide off it."""
    flight = sw.plan("stairs-industrial", "a1_wheeled", 0.6)
    run, judged = sensed(flight, step_height_error=[-0.02, 0.02, 0.02, 0.02, -0.02])
    assert run.outcome == "success", run.reason
    assert np.abs(judged[:, 8]).max() < 0.02


@pytest.mark.slow
def test_an_edge_that_is_met_higher_than_drawn_is_pushed_over() -> None:
    """A kerb of 5 cm instead of 3: wheels at its edge do not follow the plan, which waits."""
    kerb = {"points": [(-1.3, 0), (0, 0), (0, 0.03), (1.5, 0.03)]}
    run, _ = sensed(sw.plan(kerb, "b2w", 0.6), step_height_error=[0.02])
    assert run.outcome == "success", run.reason


@pytest.mark.slow
def test_wheels_that_stand_at_a_wall_stay_there_on_the_map() -> None:
    """Rear wheels lean on the riser with a push that is hardly felt, while the front ones roll."""
    ledge = {"points": [(-1.3, 0), (0, 0), (0, 0.17), (0.1, 0.17), (0.1, 0), (1.4, 0)]}
    run, judged = sensed(sw.plan(ledge, "b2w", 0.6))
    assert run.outcome == "success", run.reason
    assert np.abs(judged[:, 7]).max() < 0.025


@pytest.mark.slow
def test_a_straight_leg_feels_the_wall_that_its_wheel_climbs() -> None:
    """Rear legs are nearly straight where their wheels leave the corner before the wall."""
    wall = {"points": [(-1.3, 0), (0, 0), (0, 0.38), (1.4, 0.38)]}
    run, judged = sensed(sw.plan(wall, "anymal_wheels", 0.6))
    assert run.outcome == "success", run.reason
    assert np.abs(judged[:, 14]).max() < 0.003  # the floor is where it was drawn


def test_ideal_knowledge_of_a_wrong_place_does_not_climb(plan: Plan) -> None:
    run = rollout(plan, controller={"sensing": "ideal"}, disturbance={"x_offset": 0.03})
    assert run.outcome != "success"


@pytest.mark.slow
def test_the_filter_is_honest(plan: Plan) -> None:
    inside = [np.mean(sensed(plan, seed)[1][:, 9] < NEES_95) for seed in range(2)]
    assert np.mean(inside) > 0.9


def test_the_filter_is_honest_where_the_map_lies_otherwise_in_the_world(plan: Plan) -> None:
    run, judged = sensed(plan, face_place_error=[0.03], cross_slope=0.017)
    assert run.outcome == "success", run.reason
    assert np.mean(judged[:, 9] < NEES_95) < 0.5  # as if the map were the world
    assert np.mean(judged[:, 15] < NEES_95) > 0.9


def test_a_wrong_measure_of_length_is_learnt(plan: Plan) -> None:
    run, judged = sensed(plan, odometry_scale=0.02)
    assert run.outcome == "success", run.reason
    assert abs(judged[-1, 10]) < 0.04


@pytest.mark.slow
@pytest.mark.parametrize("plan", ["a1_wheeled"], indirect=True)
def test_the_same_seed_is_the_same_run(plan: Plan) -> None:
    one, again, other = sensed(plan, 7)[1], sensed(plan, 7)[1], sensed(plan, 8)[1]
    np.testing.assert_array_equal(one, again)
    n = min(len(one), len(other))
    assert not np.array_equal(one[:n], other[:n])


def test_slippery_ground_stops_it_safely(plan: Plan) -> None:
    run = rollout(plan, friction=0.15, controller=ROBOT)
    assert run.outcome == "stopped", run.reason
    assert "stands" in run.reason


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["a1_wheeled", "go2w"])
def test_it_knows_how_far_up_a_steep_slope_it_is(robot: str) -> None:
    """All wheels creep, and nothing tells the place along before the top."""
    slope = sw.plan({"points": [[-1.4, 0], [0, 0], [1.2, 0.72], [2.6, 0.72]]}, robot, 0.8)
    run, judged = sensed(slope)
    assert run.outcome == "success", run.reason
    assert np.abs(judged[:, 7:9]).max() < 0.006


@pytest.mark.slow
@pytest.mark.parametrize("friction", [0.1, 0.15, 0.25])
def test_a_robot_that_has_slid_away_believes_its_wheels_again(friction: float) -> None:
    """A ramp of 25 degrees turns slippery when the robot is on it: it stops by itself."""
    plan = sw.plan({"points": [[-1.4, 0], [0, 0], [1.5, -0.7], [3.5, -0.7]]}, "a1_wheeled", 0.8)
    run = Run(plan, plan.friction, parse_settings(ROBOT), Disturbance(), 0, 50.0)
    on_the_ramp = run.track.start + 0.4 * (run.track.end - run.track.start)

    def turns_slippery(_: object) -> None:
        if run.position > on_the_ramp:
            model = run.physics.model
            model.geom_friction[:, 0] = model.pair_friction[:, :2] = friction

    result = run.result(run.simulate(None, turns_slippery), keep_plan=False)
    assert result.outcome == "stopped", result.reason
    assert run.native is not None
    speed_error = run.native.judged[-5:, 4]  # in the last tenth of a second
    assert np.median(np.abs(speed_error)) < 0.05


def test_robot_sensing_needs_the_native_loop() -> None:
    with pytest.raises(InputError) as caught:
        parse_settings({"sensing": "robot", "form": "paper"})
    assert caught.value.field == ("controller", "sensing")


def test_a_robot_senses_by_itself_unless_its_controller_has_no_estimator() -> None:
    assert parse_settings(None).sensing == "robot"
    assert parse_settings({"form": "paper"}).sensing == "ideal"
    assert parse_settings({"solver": "clarabel"}).sensing == "ideal"


@pytest.mark.parametrize("plan", ["a1_wheeled"], indirect=True)
def test_a_stored_run_that_tells_no_sensing_was_ideal(plan: Plan) -> None:
    document = rollout(plan, controller={"sensing": "ideal"}).model_dump(mode="json")
    del document["controller"]["sensing"]
    assert Rollout.model_validate(document).controller.sensing == "ideal"


UP = [(-1.0, 0.0), (0.0, 0.0), (0.0, 0.2), (1.0, 0.2)]
DOWN = [(-1.0, 0.0), (0.0, 0.0), (0.0, -0.2), (1.0, -0.2)]


def matched(
    x: float,
    z: float,
    force: tuple[float, float] = (0.0, 30.0),
    points: list[tuple[float, float]] = UP,
) -> dict[str, object]:
    path = _core.WheelPath(np.array(points), RADIUS)
    spread = (0.03**2, 0.0, 0.002**2)  # unsure along, sure of the height
    return dict(_core.curve_match(path, (x, z), spread, force, 0.0, 10.0, float("nan"), 0.1))


def test_a_wheel_that_rises_is_on_the_face_although_the_tread_is_nearer() -> None:
    found = matched(-0.09, RADIUS + 0.02, (-30.0, 0.0))
    assert found["normal"] == pytest.approx((-1.0, 0.0))
    corner = 1.0 - RADIUS
    assert found["s"] == pytest.approx(corner + 0.02, abs=1e-3)


def test_a_push_tells_that_the_face_is_reached() -> None:
    assert not matched(-0.07, RADIUS)["corner"]
    assert matched(-0.07, RADIUS, (-40.0, 30.0))["corner"]


def test_a_force_that_leans_tells_that_a_wheel_is_round_an_edge() -> None:
    lean = np.radians(25)
    force = (90 * np.sin(lean), 90 * np.cos(lean))
    assert matched(-0.02, RADIUS, force, DOWN)["s"] > 1.0 + 0.5 * RADIUS * lean
    assert matched(-0.02, RADIUS, points=DOWN)["s"] == pytest.approx(0.98)


def test_a_wheel_cannot_be_beyond_a_face_that_it_does_not_feel() -> None:
    found = matched(-0.03, RADIUS)
    assert found["beyond"] == 1
    assert found["blocked"]
    assert found["s"] == pytest.approx(1.0 - RADIUS)


@pytest.mark.parametrize(
    ("name", "thigh", "calf"), [("a1_wheeled", 0.7, -1.4), ("anymal_wheels", 0.02, -0.04)]
)
def test_leg_torques_tell_the_ground_force(name: str, thigh: float, calf: float) -> None:
    """A robot stands still, held by stiff joints; straight legs tell no force along them."""
    robot = sw.load_robot(name)
    ground = sw.Terrain(points=[(-2, 0), (2, 0)], friction=0.8)
    model = build_model(robot, ground)
    data = mujoco.MjData(model)
    stiffness, damping = 10.0 * robot.mass, 0.25 * robot.mass
    data.qpos[2] = robot.nominal_height
    data.qpos[7:] = np.tile([thigh, calf, 0.0], 4)
    goal = data.qpos[7:].copy()
    for _ in range(3000):
        data.ctrl[:] = stiffness * (goal - data.qpos[7:]) - damping * data.qvel[6:]
        mujoco.mj_step(model, data)
    w, _, y, _ = data.qpos[3:7]
    pitch = 2 * np.arctan2(y, w)
    for leg in range(4):
        q, torques = data.qpos[7 + 3 * leg :][:2], tuple(data.ctrl[3 * leg :][:3])
        told, _, untold = _core.wheel_force(robot.native, leg // 2, pitch, q[0], q[1], torques)
        assert np.any(untold) == (name == "anymal_wheels")
        force = -data.sensordata[[4 * leg + 1, 4 * leg + 3]]
        assert told == pytest.approx(
            force - np.dot(force, untold) * np.array(untold), abs=0.01 * robot.mass * GRAVITY
        )
