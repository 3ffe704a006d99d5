"""Rollouts on real plans: outcomes, series, metrics, determinism, cancelling."""

from __future__ import annotations

import copy
import json
import math
from typing import get_args

import numpy as np
import pytest

import stairwright as sw
from stairwright.control.settings import ControllerSettings
from stairwright.errors import Cancelled, InputError
from stairwright.planning.plan import Plan
from stairwright.simulation.disturbance import Disturbance
from stairwright.simulation.result import Outcome, Rollout
from stairwright.simulation.rollout import rollout
from stairwright.simulation.run import Run

A1S = ("a1_wheeled", "a1_wheeled_x")

FLAT = {"name": "short-flat", "points": [[-0.6, 0.0], [0.6, 0.0]], "friction": 0.6}
STAIR = {
    "name": "stair",
    "points": [[-1.2, 0.0], [0.0, 0.0], [0.0, 0.2], [1.2, 0.2]],
    "friction": 0.6,
}


@pytest.fixture(scope="module")
def flat() -> Plan:
    return sw.plan(FLAT, "a1_wheeled", method="nominal")


@pytest.fixture(scope="module")
def shortest() -> Plan:
    """For loops in plain Python, which take a hundred times as long."""
    terrain = {"points": [[-0.35, 0.0], [0.35, 0.0]], "friction": 0.6}
    return sw.plan(terrain, "a1_wheeled", method="nominal")


@pytest.fixture(scope="module", params=A1S)
def stair(request: pytest.FixtureRequest) -> Plan:
    return sw.plan(STAIR, request.param)


@pytest.fixture(scope="module")
def climbed(stair: Plan) -> Rollout:
    return rollout(stair)


def test_climbs_a_stair(climbed: Rollout) -> None:
    metrics = climbed.metrics
    assert climbed.outcome == "success", climbed.reason
    assert metrics.link_contacts == 0
    assert metrics.self_contacts == 0
    assert metrics.end_error < 0.02
    assert metrics.pitch_error_max < math.radians(5)
    assert 0.0 < metrics.torque_peak < 33.5
    assert metrics.progress == pytest.approx(1.0)


@pytest.mark.slow
def test_what_heats_the_motors_is_told_against_what_they_hold(climbed: Rollout) -> None:
    """As a share of the continuous torque that the robot's file states, of the motor nearest it."""
    assert climbed.metrics.torque_rms is not None
    assert 1.0 < climbed.metrics.torque_rms < climbed.metrics.torque_peak
    assert climbed.metrics.continuous_share is None  # nobody publishes it of the A1
    described = climbed.robot_description.model_dump(mode="json")
    described["actuators"]["leg"]["continuous"] = 20.0
    again = rollout(sw.plan(climbed.terrain, described))
    assert again.metrics.continuous_share == pytest.approx(again.metrics.torque_rms / 20.0)


def test_series_are_consistent(climbed: Rollout) -> None:
    series, robot = climbed.series, climbed.robot_description
    assert np.allclose(np.diff(series.time), 0.01)
    np.testing.assert_allclose(np.linalg.norm(series.base_quaternion, axis=1), 1.0, atol=1e-6)
    # At rest at the end, the ground carries exactly the weight.
    weight = series.contact_force[-20:, :, 1].sum(axis=1)
    np.testing.assert_allclose(weight, robot.mass * 9.81, rtol=0.02)
    np.testing.assert_allclose(series.contact_force[-20:, :, 0].sum(axis=1), 0.0, atol=3.0)
    # The wheels do not pull at the ground.
    assert series.contact_force[..., 1].min() > -30.0
    assert series.progress_desired[-1] == pytest.approx(climbed.plan.poses[-1].progress)
    assert abs(series.progress[-1] - series.progress_desired[-1]) < 0.02
    assert (np.diff(series.progress_desired) > -1e-3).all()
    # Wheels roll without much slip: the angle asked for is the angle turned.
    assert np.abs(series.q - series.q_desired)[:, 2::3].max() < 1.5
    assert np.abs(series.q - series.q_desired)[:, 0::3].max() < 0.2


def test_document_survives_json(climbed: Rollout) -> None:
    text = climbed.model_dump_json()
    data = json.loads(text)
    assert data["schema"] == "stairwright/rollout/1"
    assert isinstance(data["series"]["q"][0], list)
    again = Rollout.model_validate(data)
    np.testing.assert_allclose(again.series.q, climbed.series.q)
    assert again.metrics == climbed.metrics
    assert again.id == climbed.id
    json.dumps(climbed.model_dump(mode="json"))


@pytest.mark.slow
def test_same_question_same_answer(flat: Plan) -> None:
    runs = [rollout(flat, seed=3, disturbance={"noise": 1.0}) for _ in range(2)]
    assert runs[0].id == runs[1].id
    np.testing.assert_array_equal(runs[0].series.q, runs[1].series.q)
    other = rollout(flat, seed=4, disturbance={"noise": 1.0})
    assert other.id != runs[0].id
    assert not np.array_equal(other.series.q, runs[0].series.q)


def test_plan_as_document_and_record_rate(flat: Plan) -> None:
    run = rollout(flat.model_dump(mode="json"), record_hz=20.0, keep_plan=False)
    assert run.success, run.reason
    assert np.allclose(np.diff(run.series.time), 0.05)
    assert run.plan is None
    assert run.plan_id == flat.id


@pytest.mark.slow
def test_the_papers_form_drives_on_flat_ground(shortest: Plan) -> None:
    run = rollout(shortest, controller={"form": "paper", "solver": "clarabel", "speed": 1.0})
    assert run.success, run.reason


@pytest.mark.slow
def test_noise_and_delay_are_the_same_for_the_compiled_and_the_plain_loop(shortest: Plan) -> None:
    world = {"noise": 1.0, "delay": 0.004}
    by_clarabel = {"solver": "clarabel", "speed": 1.0}
    plain = rollout(shortest, controller=by_clarabel, disturbance=world, seed=5)
    assert plain.success, plain.reason
    by_core = {"speed": 1.0, "sensing": "ideal"}
    fast = rollout(shortest, controller=by_core, disturbance=world, seed=5)
    n = min(len(plain.series), len(fast.series))
    assert np.abs(plain.series.pitch[:n] - fast.series.pitch[:n]).max() < 1e-3
    assert np.abs(plain.series.q[:n] - fast.series.q[:n]).max() < 0.02


@pytest.mark.slow
def test_speed_setting_is_kept(flat: Plan) -> None:
    slow, fast = (rollout(flat, controller={"speed": v}) for v in (0.1, 0.3))
    progress = np.array(fast.series.progress)
    halfway = (progress > progress[-1] / 3) & (progress < progress[-1] / 2)
    speed = np.gradient(progress, fast.series.time)[halfway]
    assert slow.metrics.duration > 2 * fast.metrics.duration - 5.0
    assert np.median(speed) == pytest.approx(0.3, rel=0.1)


def test_progress_rises_to_one_and_may_cancel(flat: Plan) -> None:
    seen: list[float] = []
    rollout(flat, progress=seen.append)
    assert seen == sorted(seen)
    assert 0.99 < seen[-1] <= 1.0

    def stop(share: float) -> None:
        if share > 0.3:
            raise Cancelled("enough")

    with pytest.raises(Cancelled):
        rollout(flat, progress=stop)


def test_nominal_pose_does_not_climb_and_says_so() -> None:
    plan = sw.plan("single-stair-036", "a1_wheeled", method="nominal")
    run = rollout(plan)
    assert run.outcome in ("fell", "stuck", "collided", "timeout", "stopped")
    assert run.metrics.progress < 0.9
    assert run.reason.endswith(".")


def test_ice_does_not_let_it_climb(stair: Plan) -> None:
    run = rollout(stair, friction=0.05)
    assert run.outcome != "success"


def test_a_plan_from_another_world_ends_honestly(flat: Plan) -> None:
    """Poses that start in the air: the robot drops and the rollout still ends with a verdict."""
    poses = [pose.model_copy(update={"z_c": pose.z_c + 0.6}) for pose in flat.poses]
    run = rollout(flat.model_copy(update={"poses": poses}))
    assert run.outcome in get_args(Outcome)


@pytest.mark.parametrize("solver", ["native", "clarabel"])
@pytest.mark.parametrize("value", [math.nan, math.inf, 1e30, 1e160])
def test_a_diverged_run_has_a_finite_document(flat: Plan, solver: str, value: float) -> None:
    settings = ControllerSettings(solver=solver)
    run = Run(flat, 0.6, settings, Disturbance(), 0, 100.0)
    run._chunk(False)
    run.data.qvel[7] = value
    ending = run.simulate(None)
    document = run.result(ending, False)
    assert document.outcome == "diverged"
    text = document.model_dump_json()
    metrics = json.loads(text, parse_constant=lambda name: pytest.fail(name))["metrics"]
    told = [number for number in metrics.values() if number is not None]
    assert all(math.isfinite(number) for number in told)


def test_bad_input_is_named(flat: Plan) -> None:
    with pytest.raises(InputError) as caught:
        rollout(flat.model_copy(update={"poses": []}))
    assert caught.value.field == ("plan",)
    for bad in (0.0, -1.0, 9.0, math.nan, "ice", True):
        with pytest.raises(InputError) as caught:
            rollout(flat, friction=bad)  # type: ignore[arg-type]
        assert caught.value.field == ("friction",)
    for name, values in {
        "record_hz": (0.0, "fast", math.nan, True),
        "seed": (-1, 0.5, "x", None, True),
        "controller": (5, "soft", {"nonsense": 1.0}),
        "disturbance": (5, {"mass": 9.0}),
    }.items():
        for value in values:
            with pytest.raises(InputError) as caught:
                rollout(flat, **{name: value})
            assert caught.value.field[0] == name
    for document in (42, None, "plan.json", {"poses": []}):
        with pytest.raises(InputError) as caught:
            rollout(document)  # type: ignore[arg-type]
        assert caught.value.field[0] == "plan"


def test_documents_that_contradict_themselves_are_refused(flat: Plan) -> None:
    document = flat.model_dump()
    for path, value in {
        ("poses", 1, "progress"): document["poses"][0]["progress"],
        ("poses", 1, "time"): -1.0,
        ("poses", 1, "collision_points"): [[0.0, 0.0]],
        ("critical",): [len(flat.poses)],
        ("friction",): 0.0,
    }.items():
        spoilt = copy.deepcopy(document)
        place = spoilt
        for key in path[:-1]:
            place = place[key]
        place[path[-1]] = value
        with pytest.raises(InputError) as caught:
            rollout(spoilt)
        assert caught.value.field[1 : 1 + len(path)] == path


@pytest.mark.slow
@pytest.mark.parametrize(
    ("terrain", "robot"),
    [
        ("ramp-30deg-025", "a1_wheeled_x"),
        ("single-stair-036", "a1_wheeled"),
        ("single-stair-036", "a1_wheeled_x"),
        ("three-stairs-up-down", "a1_wheeled_x"),
    ],
)
def test_the_papers_cases(terrain: str, robot: str) -> None:
    run = rollout(sw.plan(terrain, robot))
    assert run.outcome == "success", run.reason
    assert run.metrics.link_contacts == 0
    assert run.metrics.pitch_error_max < math.radians(5)


def test_poses_too_far_apart_are_refused() -> None:
    plan = sw.plan("flat", method="nominal").model_dump()
    plan["poses"][-1]["x_c"] = 1e6
    with pytest.raises(InputError, match="at most 500 m") as caught:
        sw.rollout(plan)
    assert caught.value.field == ("plan", "poses")
