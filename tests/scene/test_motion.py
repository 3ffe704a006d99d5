"""Motions from plans and rollouts, and the clock that plays them."""

from __future__ import annotations

import threading

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import stairwright as sw
from stairwright.robot.spatial import place
from stairwright.scene.motion import Motion, from_plan, from_rollout
from stairwright.scene.player import Player
from tests.scene.example import example_plan, example_rollout


@pytest.fixture(scope="module")
def plan():
    return example_plan(count=50)


@pytest.fixture(scope="module")
def motion(plan) -> Motion:
    found = from_plan(plan.model_dump(mode="json"), plan.robot_description)
    assert found is not None
    return found


def test_at_a_poses_time_the_robot_is_in_that_pose(plan, motion):
    for pose in plan.poses[::7]:
        moment = motion.at(pose.time)
        bodies = place(plan.robot_description, moment.position, moment.quaternion, moment.q)
        np.testing.assert_allclose(bodies.wheels[0, 0, [0, 2]], pose.wheels[0], atol=1e-6)
        np.testing.assert_allclose(bodies.wheels[0, 3, [0, 2]], pose.wheels[1], atol=1e-6)
        np.testing.assert_allclose(bodies.com[0, [0, 2]], pose.com, atol=1e-6)


def test_static_forces_carry_the_weight(plan, motion):
    weight = plan.robot_description.mass * 9.81
    np.testing.assert_allclose(motion.forces.sum(axis=1)[:, 1], weight, rtol=1e-6)
    np.testing.assert_allclose(motion.forces.sum(axis=1)[:, 0], 0.0, atol=1e-6)


def test_forces_carry_the_weight_in_corners_too():
    """There a wheel touches two faces, and the one that a pose names need not carry it."""
    plan = sw.plan("three-stairs-up", "a1_wheeled_x")
    motion = from_plan(plan.model_dump(mode="json"), plan.robot_description)
    weight = plan.robot_description.mass * 9.81
    np.testing.assert_allclose(motion.forces.sum(axis=1), [[0.0, weight]] * len(plan.poses), atol=1)


@given(st.floats(-5, 50))
def test_states_are_held_beyond_the_ends_and_turns_stay_unit(time):
    plan = example_plan(count=12)
    motion = from_plan(plan.model_dump(mode="json"), plan.robot_description)
    moment = motion.at(time)
    assert np.linalg.norm(moment.quaternion) == pytest.approx(1.0)
    if time <= 0:
        np.testing.assert_array_equal(moment.position, motion.position[0])
    if time >= motion.duration:
        np.testing.assert_array_equal(moment.q, motion.q[-1])


@pytest.mark.slow
@given(st.floats(0, 1))
def test_time_at_progress_inverts_progress_at_time(share):
    plan = example_plan(count=12)
    motion = from_plan(plan.model_dump(mode="json"), plan.robot_description)
    progress = share * motion.progress[-1]
    time = motion.time_at(progress)
    assert np.interp(time, motion.time, motion.progress) == pytest.approx(progress, abs=1e-9)


def test_sparse_plans_play_with_their_wheels_on_the_terrain(plan):
    sparse = plan.model_copy(
        update={"poses": plan.poses[::12], "critical": [0], "method": "critical"}
    )
    motion = from_plan(sparse.model_dump(mode="json"), plan.robot_description)
    assert len(motion.time) > 50
    assert motion.duration == pytest.approx(sparse.poses[-1].time)
    from shapely import LineString, Point

    ground = LineString(plan.terrain.vertices)
    bodies = place(plan.robot_description, motion.position, motion.quaternion, motion.q)
    gaps = [ground.distance(Point(x, z)) for x, z in bodies.wheels[:, 0][:, [0, 2]]]
    np.testing.assert_allclose(gaps, plan.robot_description.wheel.radius, atol=1e-3)


def test_a_plan_without_poses_or_times():
    plan = example_plan(count=5)
    document = plan.model_dump(mode="json")
    assert from_plan({**document, "poses": []}, plan.robot_description) is None
    for pose in document["poses"]:
        pose["time"] = 0.0
    motion = from_plan(document, plan.robot_description)
    assert motion.duration == pytest.approx(plan.poses[-1].progress / 0.12)


def test_a_rollout_plays_its_series():
    run = example_rollout(example_plan(count=8))
    motion = from_rollout(run.model_dump(mode="json"))
    moment = motion.at(float(run.series.time[120]))
    np.testing.assert_allclose(moment.q, run.series.q[120], atol=1e-6)
    np.testing.assert_allclose(moment.forces, run.series.contact_force[120], atol=1e-6)


class Frames:
    """Collects the times of drawn frames and lets a test wait for one."""

    def __init__(self) -> None:
        self.times: list[float] = []
        self.news = threading.Condition()

    def __call__(self, time: float) -> None:
        with self.news:
            self.times.append(time)
            self.news.notify_all()

    def wait_for(self, check) -> None:
        with self.news:
            assert self.news.wait_for(lambda: bool(self.times) and check(self.times), timeout=20)


@pytest.fixture
def frames():
    return Frames()


@pytest.fixture
def player(frames):
    player = Player(frames)
    yield player
    player.close()


def test_a_set_time_is_drawn_once_and_held_inside_the_motion(player, frames):
    player.set(duration=3.0)
    player.set(time=2.0)
    frames.wait_for(lambda times: times[-1] == 2.0)
    player.set(time=9.0)
    frames.wait_for(lambda times: times[-1] == 3.0)
    player.set(time=-1.0)
    frames.wait_for(lambda times: times[-1] == 0.0)
    assert not player.playing


def test_a_time_may_be_asked_for_before_its_motion(player, frames):
    player.set(time=2.0)
    frames.wait_for(lambda times: times[-1] == 0.0)
    player.set(duration=3.0)
    frames.wait_for(lambda times: times[-1] == 2.0)


def test_playing_may_be_asked_for_before_its_motion(player, frames):
    player.set(time=2.0, playing=True)
    frames.wait_for(lambda times: times[-1] == 0.0)
    player.set(duration=2.4)
    frames.wait_for(lambda times: times[-1] == 2.4)
    assert all(time == 0.0 or time >= 2.0 for time in frames.times)


def test_playing_runs_to_the_end_and_stops(player, frames):
    player.set(duration=0.3, speed=2.0, playing=True)
    frames.wait_for(lambda times: times[-1] == 0.3)
    assert sorted(frames.times) == frames.times
    assert not player.playing
    player.set(playing=True)
    frames.wait_for(lambda times: times.index(0.3) < len(times) - 1 and times[-1] < 0.3)


def test_a_frame_that_fails_does_not_end_playback(frames, caplog):
    def draw(time: float) -> None:
        frames(time)
        if time == 1.0:
            raise RuntimeError("no such node")

    player = Player(draw)
    try:
        player.set(duration=2.0, time=1.0)
        player.set(duration=2.0)
        player.set(time=1.0)
        frames.wait_for(lambda times: times[-1] == 1.0)
        player.set(time=2.0)
        frames.wait_for(lambda times: times[-1] == 2.0)
    finally:
        player.close()
    assert "no such node" in caplog.text
