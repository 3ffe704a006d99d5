"""One MCAP file of ROS 2 messages in memory, written without ROS: rosbags encodes the CDR."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

import numpy as np
import yaml
from mcap.writer import Writer
from rosbags.typesys import Stores, get_typestore

from stairwright.arrays import Floats
from stairwright.errors import InputError

MOST_SECONDS = 2**31 - 1  # builtin_interfaces/Time holds 32 bits
_FOREVER = {"sec": 9223372036, "nsec": 854775807}  # ROS 2's infinite duration
_KEEP_LAST, _RELIABLE, _TRANSIENT_LOCAL, _VOLATILE, _AUTOMATIC = 1, 1, 1, 2, 1
_TRIANGLE_LIST, _ADD = 11, 0  # of visualization_msgs/Marker


class Bag:
    """Topics and messages; `finish` gives the file. Frames and units are the caller's."""

    def __init__(self, metadata: dict[str, str]) -> None:
        self._store = get_typestore(Stores.ROS2_HUMBLE)
        self._of = self._store.types
        self._out = io.BytesIO()
        self._writer = Writer(self._out)
        self._writer.start(profile="ros2", library="stairwright")
        self._writer.add_metadata("stairwright", metadata)
        self._channels: dict[str, int] = {}

    def finish(self) -> bytes:
        """The bytes of the file."""
        self._writer.finish()  # type: ignore[no-untyped-call]
        return self._out.getvalue()

    def text(self, topic: str, text: str) -> None:
        """A String that whoever comes later gets too."""
        kind = "std_msgs/msg/String"
        self._write(topic, kind, 0.0, self._of[kind](text), keep=True)

    def trajectory(self, topic: str, names: Sequence[str], time: Floats, **fields: Floats) -> None:
        """A JointTrajectory.

        Args:
            topic: Where it goes.
            names: Of the m joints.
            time: (n,) from the start of the trajectory [s].
            fields: Any of positions, velocities, accelerations, effort, (n, m) each.
        """
        kind, none = "trajectory_msgs/msg/JointTrajectory", np.zeros(0)
        point, after = self._of[f"{kind}Point"], self._of["builtin_interfaces/msg/Duration"]
        known = ("positions", "velocities", "accelerations", "effort")
        columns = [np.ascontiguousarray(fields[k], float) if k in fields else None for k in known]
        points = [
            point(
                *(none if rows is None else rows[i] for rows in columns),
                time_from_start=after(*stamp(t)),
            )
            for i, t in enumerate(time)
        ]
        self._write(topic, kind, 0.0, self._of[kind](self._header(0.0, ""), list(names), points))

    def joint_states(
        self, topic: str, names: Sequence[str], time: Floats, q: Floats, dq: Floats, tau: Floats
    ) -> None:
        """A JointState per sample: positions, velocities, efforts (n, m)."""
        kind = "sensor_msgs/msg/JointState"
        q, dq, tau = (np.ascontiguousarray(a, dtype=np.float64) for a in (q, dq, tau))
        for i, t in enumerate(time):
            message = self._of[kind](self._header(t, ""), list(names), q[i], dq[i], tau[i])
            self._write(topic, kind, t, message)

    def transforms(
        self,
        topic: str,
        time: Floats,
        frames: Sequence[tuple[str, str]],
        offsets: Floats,
        turns: Floats,
        *,
        keep: bool = False,
    ) -> None:
        """A TFMessage per sample.

        Args:
            topic: ``/tf`` or ``/tf_static``.
            time: (n,) [s].
            frames: m pairs of parent and child.
            offsets: (n, m, 3) of the child in the parent [m].
            turns: (n, m, 4) wxyz of the child in the parent.
            keep: Whoever comes later gets it too.
        """
        kind = "tf2_msgs/msg/TFMessage"
        transform = self._of["geometry_msgs/msg/Transform"]
        stamped = self._of["geometry_msgs/msg/TransformStamped"]
        vector = self._of["geometry_msgs/msg/Vector3"]
        places, quaternions = np.asarray(offsets).tolist(), np.asarray(turns).tolist()
        for i, t in enumerate(time):
            moved = [
                stamped(
                    self._header(t, parent),
                    child,
                    transform(vector(*places[i][k]), self._turn(quaternions[i][k])),
                )
                for k, (parent, child) in enumerate(frames)
            ]
            self._write(topic, kind, t, self._of[kind](moved), keep=keep)

    def path(self, topic: str, frame: str, time: Floats, positions: Floats, turns: Floats) -> None:
        """A Path of positions (n, 3) and quaternions wxyz (n, 4) in `frame`."""
        kind = "nav_msgs/msg/Path"
        stamped = self._of["geometry_msgs/msg/PoseStamped"]
        poses = [
            stamped(self._header(t, frame), self._pose(position, turn))
            for t, position, turn in zip(time, positions.tolist(), turns.tolist(), strict=True)
        ]
        self._write(topic, kind, 0.0, self._of[kind](self._header(0.0, frame), poses), keep=True)

    def triangles(
        self, topic: str, frame: str, corners: Floats, colour: tuple[float, float, float, float]
    ) -> None:
        """A Marker of triangles, three of the corners (3 n, 3) each, in `frame`."""
        kind = "visualization_msgs/msg/Marker"
        point, vector = self._of["geometry_msgs/msg/Point"], self._of["geometry_msgs/msg/Vector3"]
        names = [field for field, _ in self._store.fielddefs[kind][1]]
        unused = {
            "colors": [], "texture_resource": "", "uv_coordinates": [], "text": "",
            "texture": self._of["sensor_msgs/msg/CompressedImage"](
                self._header(0.0, ""), "", np.zeros(0, dtype=np.uint8)
            ),
            "mesh_resource": "", "mesh_use_embedded_materials": False,
            "mesh_file": self._of["visualization_msgs/msg/MeshFile"](
                "", np.zeros(0, dtype=np.uint8)
            ),
        }  # fmt: skip
        used = {
            "header": self._header(0.0, frame),
            "ns": topic.strip("/"),
            "id": 0,
            "type": _TRIANGLE_LIST,
            "action": _ADD,
            "pose": self._pose([0.0] * 3, [1.0, 0.0, 0.0, 0.0]),
            "scale": vector(1.0, 1.0, 1.0),
            "color": self._of["std_msgs/msg/ColorRGBA"](*colour),
            "lifetime": self._of["builtin_interfaces/msg/Duration"](0, 0),
            "frame_locked": True,
            "points": [point(*corner) for corner in corners.tolist()],
        }
        fields = {**unused, **used}
        message = self._of[kind](**{name: fields[name] for name in names})
        self._write(topic, kind, 0.0, message, keep=True)

    def _header(self, time: float, frame: str) -> Any:
        made = self._of["builtin_interfaces/msg/Time"](*stamp(time))
        return self._of["std_msgs/msg/Header"](made, frame)

    def _pose(self, position: Sequence[float], turn: Sequence[float]) -> Any:
        place = self._of["geometry_msgs/msg/Point"](*position)
        return self._of["geometry_msgs/msg/Pose"](place, self._turn(turn))

    def _turn(self, wxyz: Sequence[float]) -> Any:
        w, x, y, z = wxyz
        return self._of["geometry_msgs/msg/Quaternion"](x, y, z, w)

    def _write(self, topic: str, kind: str, time: float, message: Any, keep: bool = False) -> None:
        if topic not in self._channels:
            text, _ = self._store.generate_msgdef(kind, ros_version=2)
            schema = self._writer.register_schema(kind, "ros2msg", text.encode())
            qos = {"offered_qos_profiles": _qos(keep)}
            self._channels[topic] = self._writer.register_channel(topic, "cdr", schema, qos)
        seconds, nanoseconds = stamp(time)
        at = seconds * 10**9 + nanoseconds
        data = bytes(self._store.serialize_cdr(message, kind))
        self._writer.add_message(self._channels[topic], at, data, at)


def _qos(keep: bool) -> str:
    """How ``ros2 bag play`` publishes a topic; `keep`: late subscribers get the last message."""
    profile = {
        "history": _KEEP_LAST,
        "depth": 1 if keep else 10,
        "reliability": _RELIABLE,
        "durability": _TRANSIENT_LOCAL if keep else _VOLATILE,
        "deadline": dict(_FOREVER),
        "lifespan": dict(_FOREVER),
        "liveliness": _AUTOMATIC,
        "liveliness_lease_duration": dict(_FOREVER),
        "avoid_ros_namespace_conventions": False,
    }
    return str(yaml.safe_dump([profile], sort_keys=False))


def stamp(time: float) -> tuple[int, int]:
    """Seconds and nanoseconds of a time from 0 [s].

    Raises:
        InputError: If ROS messages do not hold it.
    """
    if not 0.0 <= time < MOST_SECONDS:
        raise InputError(f"must lie between 0 and {MOST_SECONDS} s in ROS messages", ("time",))
    return divmod(round(float(time) * 1e9), 10**9)
