"""MCAP files of ours, read by Foxglove's own reader (mcap, mcap-ros2-support)."""

from __future__ import annotations

import io
from typing import Any

import mujoco
import numpy as np
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory


def messages(content: bytes) -> dict[str, list[tuple[float, Any]]]:
    """Messages of each topic with the times when they were logged [s]."""
    reader = make_reader(io.BytesIO(content), decoder_factories=[DecoderFactory()])
    topics: dict[str, list[tuple[float, Any]]] = {}
    for _, channel, raw, message in reader.iter_decoded_messages():
        topics.setdefault(channel.topic, []).append((raw.log_time * 1e-9, message))
    return topics


def metadata(content: bytes) -> dict[str, str]:
    """The file's one metadata record."""
    (record,) = make_reader(io.BytesIO(content)).iter_metadata()
    return dict(record.metadata)


def world(message: Any, name: str) -> np.ndarray:
    """Frame `name` in the world (4, 4), as one TFMessage has it."""
    stamped = {t.child_frame_id: t for t in message.transforms}
    out = np.eye(4)
    while name in stamped:
        moved, local = stamped[name].transform, np.eye(4)
        turn, place = moved.rotation, moved.translation
        matrix = np.zeros(9)
        mujoco.mju_quat2Mat(matrix, np.array([turn.w, turn.x, turn.y, turn.z]))
        local[:3, :3], local[:3, 3] = matrix.reshape(3, 3), (place.x, place.y, place.z)
        out, name = local @ out, stamped[name].header.frame_id
    return out
