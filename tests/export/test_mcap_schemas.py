"""Every message of an MCAP file is what the ROS schema in the file says, to the last byte."""

from __future__ import annotations

import io

import pytest
from mcap.reader import make_reader
from mcap_ros2._dynamic import serialize_dynamic
from mcap_ros2.decoder import DecoderFactory
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from stairwright.export.table import PLAN_FORMATS, ROLLOUT_FORMATS
from tests.scene.example import example_plan, example_rollout

PLAN = example_plan(count=60)
FILES = {
    "plan": lambda: PLAN_FORMATS["mcap"].write(PLAN, 50.0),
    "rollout": lambda: ROLLOUT_FORMATS["mcap"].write(example_rollout(PLAN)),
}
KINDS = {
    "/robot_description": "std_msgs/msg/String",
    "/tf_static": "tf2_msgs/msg/TFMessage",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/terrain": "visualization_msgs/msg/Marker",
    "/path": "nav_msgs/msg/Path",
    "/joint_states": "sensor_msgs/msg/JointState",
    "/joint_trajectory": "trajectory_msgs/msg/JointTrajectory",
    "/joint_trajectory_without_effort": "trajectory_msgs/msg/JointTrajectory",
    "/wheel_trajectory": "trajectory_msgs/msg/JointTrajectory",
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", FILES)
def test_messages_keep_to_their_schemas(kind: str) -> None:
    """Decoded and encoded again by a second implementation, from the file's own schema."""
    encoders, seen = {}, set()
    reader = make_reader(io.BytesIO(FILES[kind]()), decoder_factories=[DecoderFactory()])
    for schema, channel, raw, message in reader.iter_decoded_messages():
        assert (schema.name, schema.encoding) == (KINDS[channel.topic], "ros2msg")
        assert channel.message_encoding == "cdr"
        if schema.name not in encoders:
            made = serialize_dynamic(schema.name, schema.data.decode())
            encoders[schema.name] = made[schema.name]
        assert encoders[schema.name](message) == raw.data, channel.topic
        seen.add(channel.topic)
    commands = {"/joint_trajectory_without_effort", "/wheel_trajectory"}
    assert seen == (set(KINDS) if kind == "plan" else set(KINDS) - commands)


@pytest.mark.slow
@pytest.mark.parametrize("kind", FILES)
def test_schemas_are_those_of_ros(kind: str) -> None:
    """The definitions in the file, parsed alone, hash as ROS 2's own types do."""
    known = get_typestore(Stores.ROS2_HUMBLE)
    schemas = make_reader(io.BytesIO(FILES[kind]())).get_summary().schemas.values()
    assert {schema.name for schema in schemas} == set(KINDS.values())
    for schema in schemas:
        alone = get_typestore(Stores.EMPTY)
        alone.register(get_types_from_msg(schema.data.decode(), schema.name))
        assert alone.hash_rihs01(schema.name) == known.hash_rihs01(schema.name), schema.name
