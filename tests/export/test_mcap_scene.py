"""What a viewer needs to show the robot on its terrain at once, in plans and in rollouts."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
import pytest
from rosbags.highlevel import AnyReader
from rosbags.interfaces import QosDurability

from stairwright.export import mcap_file
from stairwright.export.table import PLAN_FORMATS, ROLLOUT_FORMATS
from stairwright.robot.description import JOINTS
from tests.export.mcap_reading import messages, world
from tests.scene.example import example_plan, example_rollout

PLAN = example_plan(count=300)  # so many that joints moving evenly between them stay close
RUN = example_rollout(PLAN)
FILES = {
    "plan": lambda: PLAN_FORMATS["mcap"].write(PLAN),
    "rollout": lambda: ROLLOUT_FORMATS["mcap"].write(RUN),
}
KEPT = {"/robot_description", "/tf_static", "/terrain", "/path"}
MOVING = {"/tf", "/joint_states", "/joint_trajectory"}


@pytest.fixture(scope="module", params=FILES)
def content(request: pytest.FixtureRequest) -> bytes:
    return FILES[request.param]()


@pytest.fixture(scope="module")
def topics(content: bytes) -> dict:
    return messages(content)


@pytest.mark.slow
def test_topics(topics) -> None:
    assert set(topics) - {"/joint_trajectory_without_effort", "/wheel_trajectory"} == KEPT | MOVING
    for name in KEPT:
        ((at, _),) = topics[name]
        assert at == 0.0


@pytest.mark.slow
def test_late_subscribers_get_what_does_not_change(content, tmp_path) -> None:
    (tmp_path / "file.mcap").write_bytes(content)
    with AnyReader([tmp_path / "file.mcap"]) as reader:
        for connection in reader.connections:
            (qos,) = connection.ext.offered_qos_profiles
            kept = qos.durability is QosDurability.TRANSIENT_LOCAL
            assert kept == (connection.topic in KEPT), connection.topic


@pytest.mark.slow
def test_every_link_of_the_robot_has_its_frame(topics) -> None:
    """One tree from the world on, each frame with one parent, and the URDF's joints in it."""
    root = ET.fromstring(topics["/robot_description"][0][1].data)
    links = {link.get("name") for link in root.iter("link")}
    static, moving = topics["/tf_static"][0][1].transforms, topics["/tf"][7][1].transforms
    parents = {t.child_frame_id: t.header.frame_id for t in [*static, *moving]}
    assert len(parents) == len(static) + len(moving)
    assert set(parents) == links
    assert parents["trunk"] == "world"
    for joint in root.iter("joint"):
        parent, child = joint.find("parent").get("link"), joint.find("child").get("link")
        assert parents[child] == parent
        (stamped,) = [t for t in [*static, *moving] if t.child_frame_id == child]
        place = stamped.transform.translation
        offset = [float(v) for v in joint.find("origin").get("xyz").split()]
        np.testing.assert_allclose((place.x, place.y, place.z), offset, atol=1e-12)
    named = {joint.get("name") for joint in root.iter("joint") if joint.get("type") != "fixed"}
    assert named == set(JOINTS) == set(topics["/joint_states"][0][1].name)


@pytest.mark.slow
def test_wheels_stand_on_the_terrain_that_is_shown(topics) -> None:
    """The wheels' lowest points, from the transforms, lie on the marker's surface."""
    (_, marker), radius = topics["/terrain"][0], PLAN.robot_description.wheel.radius
    assert (marker.header.frame_id, marker.type, marker.action) == ("world", 11, 0)
    assert (marker.scale.x, marker.pose.orientation.w, marker.color.a) == (1.0, 1.0, 1.0)
    corners = np.array([(p.x, p.y, p.z) for p in marker.points]).reshape(-1, 3, 3)
    top = corners[np.ptp(corners[:, :, 1], axis=1) > 0.0]  # the others are the cut faces
    surface = np.unique(np.round(top.reshape(-1, 3)[:, [0, 2]], 9), axis=0)
    np.testing.assert_allclose(surface, np.unique(PLAN.terrain.vertices, axis=0), atol=1e-9)
    area = np.linalg.norm(np.cross(top[:, 1] - top[:, 0], top[:, 2] - top[:, 0]), axis=1) / 2
    length = np.hypot(*np.diff(PLAN.terrain.vertices, axis=0).T).sum()
    assert area.sum() == pytest.approx(length * np.ptp(top[:, :, 1]))
    segments = list(zip(PLAN.terrain.vertices[:-1], PLAN.terrain.vertices[1:], strict=True))
    for _, message in topics["/tf"][:: max(1, len(topics["/tf"]) // 25)]:
        for name in ("FR_wheel", "RL_wheel"):
            centre = world(message, name)[[0, 2], 3]
            gaps = []
            for a, b in segments:
                share = np.clip((centre - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
                gaps.append(np.linalg.norm(a + share * (b - a) - centre))
            assert min(gaps) == pytest.approx(radius, abs=0.005)


@pytest.mark.slow
def test_the_path_is_the_trunks(topics) -> None:
    ((_, path),), states = topics["/path"], topics["/tf"]
    assert path.header.frame_id == "world"
    assert len(path.poses) == len(states)
    for stamped, (at, message) in zip(path.poses[::9], states[::9], strict=True):
        trunk, place = message.transforms[0].transform.translation, stamped.pose.position
        assert stamped.header.stamp.sec + stamped.header.stamp.nanosec * 1e-9 == pytest.approx(at)
        assert (trunk.x, trunk.y, trunk.z) == (place.x, place.y, place.z)


@pytest.mark.slow
def test_a_plans_states_are_its_commands() -> None:
    """The state at a time is the trajectory's at that time; wheels start at 0."""
    topics = messages(FILES["plan"]())
    ((_, legs),) = topics["/joint_trajectory"]
    sent = {
        round((p.time_from_start.sec + p.time_from_start.nanosec * 1e-9) * 1e6): p
        for p in legs.points
    }
    states = topics["/joint_states"]
    assert not np.array(states[0][1].position)[2::3].any()
    np.testing.assert_allclose(np.diff([at for at, _ in states])[:-1], 0.02, atol=1e-9)
    for at, state in states[1:]:
        point = sent[round(at * 1e6)]
        values = dict(zip(state.name, state.position, strict=True))
        assert [values[name] for name in legs.joint_names] == list(point.positions)
    assert states[-1][0] == pytest.approx(max(sent) * 1e-6)
    assert not np.array(states[-1][1].velocity).any()


def test_a_plan_that_does_not_move_has_its_scene() -> None:
    still = PLAN.model_copy(update={"poses": PLAN.poses[:1], "critical": []})
    assert set(messages(PLAN_FORMATS["mcap"].write(still))) == KEPT - {"/path"}


@pytest.mark.slow
def test_long_plans_are_shown_with_fewer_states(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mcap_file, "MOST_STATES", 300)
    topics = messages(PLAN_FORMATS["mcap"].write(PLAN))
    assert 200 < len(topics["/tf"]) == len(topics["/joint_states"]) <= 301
    assert len(topics["/joint_trajectory"][0][1].points) > 100 * PLAN.timing.total
