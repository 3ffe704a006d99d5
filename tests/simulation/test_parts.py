"""Motors, governor, verdicts, deviations and trials."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import stairwright as sw
from stairwright import _core
from stairwright.control.setpoint import ACCELERATIONS, COM, PROGRESS, RATES, WIDTH
from stairwright.control.settings import ControllerSettings
from stairwright.errors import InputError
from stairwright.planning.poses.interpolation import reference
from stairwright.robot.mujoco_model import build_spec
from stairwright.simulation.disturbance import Disturbance
from stairwright.simulation.governor import follower, track
from stairwright.simulation.intervals import clopper_pearson, wilson
from stairwright.simulation.outcome import Ending, LinkLoads, ProgressWatch, fallen, judge
from stairwright.simulation.ranges import Ranges, chosen_ranges, draw
from stairwright.simulation.sensors import Sensors
from stairwright.simulation.trials import trials
from stairwright.simulation.world import disturb_trunk, real_terrain
from stairwright.terrain.wheel_path import wheel_path

FLAT = {"name": "short-flat", "points": [[-0.6, 0.0], [0.6, 0.0]], "friction": 0.6}
SHORTEST = {"points": [[-0.35, 0.0], [0.35, 0.0]], "friction": 0.6}
WEIGHT = 11.84 * 9.81


@given(st.floats(-100, 100), st.floats(-60, 60))
def test_motor_line(torque: float, speed: float) -> None:
    got = _core.available_torque(_core.Motor(33.5, 21.0), torque, speed)
    assert abs(got) <= min(abs(torque), 33.5) + 1e-12
    assert got * torque >= 0.0
    if torque * speed > 0.0:
        assert abs(got) <= 33.5 * max(0.0, 1.0 - abs(speed) / 21.0) + 1e-12
    elif abs(torque) <= 33.5:
        assert got == torque  # braking has the full peak


def track_of(plan, **settings: float):
    robot = plan.robot_description
    path = wheel_path(plan.terrain, robot.wheel.radius)
    return track(reference(plan), robot, path, plan.friction, ControllerSettings(**settings))


def run_governor(lag: float, steps: int = 3000):
    line = track_of(sw.plan(FLAT, "a1_wheeled", method="nominal"), speed=0.1)
    plan, target = follower(line, 0.012), np.empty(WIDTH)
    rates = []
    for _ in range(steps):
        s = np.interp(
            plan.position, line.start + line.step * np.arange(len(line.rows)), line.rows[:, 0]
        )
        behind = s - line.rows[0, 0] - lag
        places = np.repeat(line.rows[0, :2] + behind, 2)
        target = plan.advance(places, True, 0.002)
        rates.append(plan.rate)
    return line, plan, target, np.array(rates)


def test_governor_keeps_time_with_a_robot_that_follows() -> None:
    line, timed, target, rates = run_governor(0.0)
    assert rates.max() == pytest.approx(0.1, rel=1e-6)
    assert np.abs(np.diff(rates)).max() <= 1.0 * 0.002 + 1e-9
    assert target[RATES] == pytest.approx(timed.rate, rel=1e-6)
    assert timed.position < line.end


def test_governor_waits_for_a_held_robot_and_retreats_with_a_sliding_one() -> None:
    _, held, _, _ = run_governor(0.012)
    assert held.rate == pytest.approx(0.0, abs=1e-6)
    _, _, _, rates = run_governor(0.02)
    assert rates.min() <= 0.0
    _, _, _, rates = run_governor(-0.05)
    assert rates.max() <= 0.15 + 1e-6  # it hurries, but does not jump


def test_track_limits_joint_speed() -> None:
    plan = sw.plan("curb-015", "a1_wheeled", method="critical")
    line = track_of(plan, joint_speed=0.5)
    rates = np.abs(line.rows[:, RATES + 2 : RATES + 6]).max(axis=1) * line.speeds
    assert rates.max() <= 0.5 + 1e-6


def travel(places: np.ndarray) -> np.ndarray:
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(places, axis=0).T))])


def test_a_trunk_that_swings_above_standing_wheels_takes_its_time() -> None:
    """There progress tells little: on a scale of it alone a swing went by in half its time."""
    ramp = [(-1.3, 0.0), (0.0, 0.0), (0.169, 0.365), (0.436, 0.365), (0.436, 0.311)]
    plan = sw.plan({"points": [*ramp, (0.886, 0.294), (2.186, 0.294)]}, "a1_wheeled", 0.35)
    course, line = reference(plan), track_of(plan)
    moved = travel(course.trunk[:, :2])
    assert (np.diff(moved) / np.diff(course.progress)).max() > 5.0
    way = travel(line.rows[:, 9:11])
    mean = 0.5 * (line.speeds[1:] + line.speeds[:-1])
    driven = np.concatenate([[0.0], np.cumsum(line.step / mean)])
    marks = np.arange(0.05, moved[-1], 0.05)
    planned = np.diff(np.interp(marks, moved, course.time))
    assert (np.diff(np.interp(marks, way * moved[-1] / way[-1], driven)) > 0.95 * planned).all()
    assert line.rows[-1, PROGRESS] == pytest.approx(course.progress[-1])
    assert (np.diff(line.rows[:, PROGRESS]) > 0.0).all()


def test_accelerations_belong_to_the_speeds() -> None:
    """What is fed forward is the time derivative of the CoM velocity that is asked for."""
    line = track_of(sw.plan("curb-015", "a1_wheeled", method="critical"))
    plan, dt = follower(line, 0.01), 0.002
    places, rows = np.full(4, np.nan), []
    while plan.position < line.end - 1e-9:
        rows.append(plan.advance(places, True, dt))
    velocity, surge = (
        np.array(rows)[:, RATES + COM.start],
        np.array(rows)[:, ACCELERATIONS + COM.start],
    )
    window = 25  # control steps: the table's rows are coarser than one
    change = (velocity[window:] - velocity[:-window]) / (window * dt)
    mean = np.convolve(surge, np.full(window, 1 / window), "valid")[: len(change)]
    inside = slice(500, -500)  # at both ends the plan stands still by rules of its own
    assert np.abs(change[inside]).max() > 0.1
    assert np.corrcoef(change[inside], mean[inside])[0, 1] > 0.95
    assert np.abs(change - mean)[inside].mean() < 0.15 * np.abs(change[inside]).max()


@pytest.mark.parametrize(
    ("ending", "load", "outcome"),
    [
        (Ending("arrived", 9.0, (1.0, 1.0), 0.001), 0.0, "success"),
        (Ending("arrived", 9.0, (1.0, 1.0), 0.001), 3.0, "success"),
        (Ending("arrived", 9.0, (1.0, 1.0), 0.001), 300.0, "collided"),
        (Ending("arrived", 9.0, (1.0, 1.0), 0.03), 0.0, "stuck"),
        (Ending("stuck", 9.0, (0.5, 1.0), 0.5), 0.0, "stuck"),
        (Ending("stuck", 9.0, (0.5, 1.0), 0.5), 300.0, "collided"),
        (Ending("fell", 9.0, (0.5, 1.0), 0.5, "tipped"), 300.0, "fell"),
        (Ending("timeout", 9.0, (0.5, 1.0), 0.5), 0.0, "timeout"),
        (Ending("diverged", 9.0, (0.5, 1.0), math.inf), 0.0, "diverged"),
    ],
)
def test_verdicts(ending: Ending, load: float, outcome: str) -> None:
    loads = LinkLoads(0.002)
    for k in range(20):
        loads.add(0.002 * k, {"FL_calf": load} if load else {})
    verdict, reason = judge(ending, loads, WEIGHT)
    assert verdict == outcome
    assert reason.endswith(".")
    if outcome == "collided" and ending.cause != "arrived":
        assert reason.endswith(" The run ended at 9.0 s, 0.50 m of 1.00 m along the plan.")


def test_a_tap_is_a_graze_and_a_push_is_a_load() -> None:
    tap, push = LinkLoads(0.002), LinkLoads(0.002)
    tap.add(0.0, {"trunk": 20.0})
    for k in range(50):
        tap.add(0.002 * k, {})
        push.add(0.002 * k, {"trunk": 20.0})
    assert tap.contacts == 1
    assert tap.peak == pytest.approx(2.0)
    assert push.peak == pytest.approx(20.0, rel=0.01)
    assert push.where[0] == "trunk"


def test_parts_that_touch_each_other_are_named_with_the_time() -> None:
    loads = LinkLoads(0.002)
    for k in range(4):
        loads.add(0.1 * k, {}, ("RL_wheel", "FL_calf") if k % 2 else ())
    verdict, reason = judge(Ending("arrived", 9.0, (1.0, 1.0), 0.001), loads, WEIGHT)
    assert loads.self_contacts == 2
    assert verdict == "collided"
    assert reason == "The front left calf and the rear left wheel touched each other at 0.1 s."


def test_falling_and_being_stuck() -> None:
    assert "backward" in fallen(-1.2, 0.0, 0.3, 0.0)
    assert "sideways" in fallen(0.0, 1.2, 0.3, 0.0)
    assert "dropped" in fallen(0.0, 0.0, -0.5, 0.0)
    assert fallen(0.5, 0.5, 0.3, 0.0) == ""
    watch = ProgressWatch()
    assert not any(watch.stuck(0.1 * k, 0.001 * k) for k in range(100))
    assert watch.stuck(20.0, 0.0)


def test_deviations_change_what_they_say() -> None:
    robot, terrain = sw.load_robot("a1_wheeled"), sw.load_terrain("three-stairs-up")
    higher = real_terrain(terrain, Disturbance(height=0.03), 0)
    assert np.ptp(higher.vertices[:, 1]) == pytest.approx(0.375 + 0.03)
    assert real_terrain(terrain, Disturbance(), 0) is terrain
    for deviation in (Disturbance(mass=0.1, com_x=0.02), Disturbance(com_z=-0.02)):
        spec = build_spec(robot, visual=False)
        disturb_trunk(spec, robot, deviation)
        model = spec.compile()
        data = mujoco.MjData(model)
        data.qpos[:4] = 0.0, 0.0, 0.0, 1.0
        mujoco.mj_forward(model, data)
        plain = mujoco.MjData(build_spec(robot, visual=False).compile())
        plain.qpos[:] = data.qpos
        mujoco.mj_forward(build_spec(robot, visual=False).compile(), plain)
        assert model.body_mass.sum() == pytest.approx(11.84 * (1 + deviation.mass))
        moved = (11.84 * plain.subtree_com[1]) / (11.84 * (1 + deviation.mass))
        expected = moved + np.array([deviation.com_x, 0.0, deviation.com_z])
        np.testing.assert_allclose(data.subtree_com[1], expected, atol=1e-9)


def test_sensors_are_late_and_noisy() -> None:
    qpos, qvel = np.zeros(19), np.zeros(18)
    qpos[3] = 1.0
    late = Sensors(Disturbance(delay=0.004), 0.002, 0)
    seen = []
    for k in range(5):
        qpos[0] = k
        seen.append(late.sense(qpos, qvel)[0][0])
    assert seen == [0, 0, 0, 1, 2]
    noisy = Sensors(Disturbance(noise=2.0), 0.002, 0)
    rows = np.array([noisy.sense(qpos, qvel)[1] for _ in range(2000)])
    assert rows[:, 8].std() == pytest.approx(0.1, rel=0.1)
    seen, _ = Sensors(Disturbance(), 0.002, 0).sense(qpos, qvel)
    np.testing.assert_array_equal(seen, qpos)


def test_intervals() -> None:
    low, high = wilson(95, 100)
    assert (low, high) == pytest.approx((0.8882, 0.9785), abs=1e-3)
    assert clopper_pearson(95, 100) == pytest.approx((0.8872, 0.9836), abs=1e-3)
    assert clopper_pearson(0, 10)[0] == 0.0
    assert clopper_pearson(10, 10)[1] == 1.0
    assert wilson(10, 10)[1] == pytest.approx(1.0)


def test_draws_are_seeded_and_in_range() -> None:
    ranges = Ranges(friction=(-0.05, 0.0))
    first, again = draw(ranges, 50, 1), draw(ranges, 50, 1)
    assert first == again
    assert first != draw(ranges, 50, 2)
    assert all(-0.05 <= d.friction <= 0.0 and d.delay == 0.004 for d in first)
    with pytest.raises(InputError):
        chosen_ranges({"friction": (0.1, -0.1)})


@pytest.mark.slow
def test_trials_report() -> None:
    plan = sw.plan(FLAT, "a1_wheeled", method="nominal")
    seen: list[float] = []
    report = trials(plan, 3, seed=5, progress=seen.append)
    assert report.count == 3
    assert report.successes == 3
    assert report.rate == 1.0
    assert seen[-1] == 1.0
    assert report.model_dump(mode="json")["schema"] == "stairwright/trials/1"
    with pytest.raises(InputError) as caught:
        trials(plan, 3, ranges={"wind": (0, 1)})
    assert caught.value.field == ("ranges", "wind")


@pytest.mark.parametrize(
    "solver",
    ["native", pytest.param("clarabel", marks=pytest.mark.slow)],
    ids=["threads", "processes"],
)
def test_workers_change_nothing(solver: str) -> None:
    plan = sw.plan(SHORTEST, "a1_wheeled", method="nominal")
    # It tips over at once, each time in another way.
    asked = {"controller": {"solver": solver}, "ranges": {"com_x": (-0.2, -0.15)}}
    alone, shared = (trials(plan, 2, seed=1, workers=w, **asked) for w in (1, 2))
    assert alone.successes == 0
    assert alone.trials == shared.trials
