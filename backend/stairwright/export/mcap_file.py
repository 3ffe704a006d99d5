"""MCAP for ROS 2 and Foxglove, written without ROS.

A plan is one ``trajectory_msgs/JointTrajectory`` and the trunk's transforms; a rollout is joint
states, transforms of every link, and the desired trajectory. Quaternions are xyzw here and only
here. Times count from zero.
"""

from __future__ import annotations

import io
import json
from typing import Any

import numpy as np
from mcap.writer import Writer
from numpy.typing import NDArray
from rosbags.typesys import Stores, get_typestore

from stairwright.errors import InputError
from stairwright.planning.plan import Plan
from stairwright.robot import spatial
from stairwright.robot.description import JOINTS, LEGS, Robot
from stairwright.simulation.result import Rollout

from .columns import FRAMES, UNITS, plan_arrays

Floats = NDArray[np.float64]
WORLD, TRUNK = "world", "trunk"
MOST_SECONDS = 2**31 - 1  # builtin_interfaces/Time holds 32 bits
_TRAJECTORY = "trajectory_msgs/msg/JointTrajectory"
_JOINT_STATE = "sensor_msgs/msg/JointState"
_TF = "tf2_msgs/msg/TFMessage"


def plan_mcap(plan: Plan) -> bytes:
    """``/joint_trajectory`` (all poses), ``/tf`` (every link at each pose)."""
    arrays = plan_arrays(plan)
    robot = plan.robot_description
    position, quaternion, joints = spatial.lift(
        robot, arrays["trunk"], arrays["q"], arrays["wheel_progress"]
    )
    bag = _Bag({"id": plan.id, "method": plan.method, **_about(plan)})
    bag.trajectory("/joint_trajectory", arrays["time"], joints)
    bag.transforms(robot, arrays["time"], position, quaternion, joints)
    return bag.finish()


def rollout_mcap(rollout: Rollout) -> bytes:
    """``/joint_states``, ``/tf``, and ``/joint_trajectory`` (what was asked of the joints)."""
    s = rollout.series
    bag = _Bag(
        {
            "id": rollout.id,
            "plan_id": rollout.plan_id,
            "outcome": rollout.outcome,
            **_about(rollout),
        }
    )
    bag.trajectory("/joint_trajectory", s.time, s.q_desired)
    bag.joint_states("/joint_states", s.time, s.q, s.dq, s.torque)
    bag.transforms(rollout.robot_description, s.time, s.base_position, s.base_quaternion, s.q)
    return bag.finish()


def _about(document: Plan | Rollout) -> dict[str, str]:
    return {
        "schema": document.schema_,
        "terrain": document.terrain.name,
        "terrain_hash": document.terrain_hash,
        "robot": document.robot,
        "robot_hash": document.robot_hash,
        "friction": repr(document.friction),
        "units": UNITS,
        "frames": FRAMES + "; quaternions xyzw",
        "joint_order": json.dumps(JOINTS),
    }


class _Bag:
    """One MCAP file in memory. Messages are encoded as CDR by rosbags."""

    def __init__(self, metadata: dict[str, str]) -> None:
        self._types = get_typestore(Stores.ROS2_HUMBLE)
        self._out = io.BytesIO()
        self._writer = Writer(self._out)
        self._writer.start(profile="ros2", library="stairwright")
        self._writer.add_metadata("stairwright", metadata)
        self._channels: dict[str, int] = {}

    def finish(self) -> bytes:
        """The bytes of the file."""
        self._writer.finish()  # type: ignore[no-untyped-call]
        return self._out.getvalue()

    def trajectory(self, topic: str, time: Floats, q: Floats) -> None:
        """One JointTrajectory with a point per row of `q` (n, 12)."""
        of = self._types.types
        none = np.zeros(0)
        points = [
            of["trajectory_msgs/msg/JointTrajectoryPoint"](
                positions=np.ascontiguousarray(row, dtype=np.float64),
                velocities=none,
                accelerations=none,
                effort=none,
                time_from_start=of["builtin_interfaces/msg/Duration"](*_stamp(t)),
            )
            for t, row in zip(time, q, strict=True)
        ]
        message = of[_TRAJECTORY](self._header(0.0, ""), list(JOINTS), points)
        self._write(topic, _TRAJECTORY, 0.0, message)

    def joint_states(self, topic: str, time: Floats, q: Floats, dq: Floats, tau: Floats) -> None:
        """A JointState per sample: positions, velocities, efforts (n, 12)."""
        make = self._types.types[_JOINT_STATE]
        q, dq, tau = (np.ascontiguousarray(a, dtype=np.float64) for a in (q, dq, tau))
        for i, t in enumerate(time):
            message = make(self._header(t, ""), list(JOINTS), q[i], dq[i], tau[i])
            self._write(topic, _JOINT_STATE, t, message)

    def transforms(
        self, robot: Robot, time: Floats, position: Floats, quaternion: Floats, q: Floats
    ) -> None:
        """A TFMessage per sample: world to trunk, trunk to thigh to calf to wheel of each leg."""
        of = self._types.types
        vector, turn = of["geometry_msgs/msg/Vector3"], of["geometry_msgs/msg/Quaternion"]
        transform, stamped = (
            of["geometry_msgs/msg/Transform"],
            of["geometry_msgs/msg/TransformStamped"],
        )
        offsets = [
            offset
            for hip in spatial.hip_offsets(robot)
            for offset in (hip, (0.0, 0.0, -robot.thigh.length), (0.0, 0.0, -robot.calf.length))
        ]
        moves = [vector(*(float(v) for v in offset)) for offset in offsets]
        parents = [p for leg in LEGS for p in (TRUNK, f"{leg}_thigh", f"{leg}_calf")]
        half = np.asarray(q, float) / 2
        sines, cosines = np.sin(half), np.cos(half)
        for i, t in enumerate(time):
            w, x, y, z = (float(v) for v in quaternion[i])
            place = transform(vector(*(float(v) for v in position[i])), turn(x, y, z, w))
            links = [stamped(self._header(t, WORLD), TRUNK, place)]
            for j, name in enumerate(JOINTS):
                about_y = turn(0.0, float(sines[i, j]), 0.0, float(cosines[i, j]))
                header = self._header(t, parents[j])
                links.append(stamped(header, name, transform(moves[j], about_y)))
            self._write("/tf", _TF, t, of[_TF](links))

    def _header(self, time: float, frame: str) -> Any:
        of = self._types.types
        return of["std_msgs/msg/Header"](of["builtin_interfaces/msg/Time"](*_stamp(time)), frame)

    def _write(self, topic: str, kind: str, time: float, message: Any) -> None:
        if topic not in self._channels:
            text, _ = self._types.generate_msgdef(kind, ros_version=2)
            schema = self._writer.register_schema(kind, "ros2msg", text.encode())
            self._channels[topic] = self._writer.register_channel(topic, "cdr", schema)
        seconds, nanoseconds = _stamp(time)
        stamp = seconds * 10**9 + nanoseconds
        data = bytes(self._types.serialize_cdr(message, kind))
        self._writer.add_message(self._channels[topic], stamp, data, stamp)


def _stamp(time: float) -> tuple[int, int]:
    if not 0.0 <= time < MOST_SECONDS:
        raise InputError(f"must lie between 0 and {MOST_SECONDS} s in ROS messages", ("time",))
    return divmod(round(float(time) * 1e9), 10**9)
