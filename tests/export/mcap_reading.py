"""MCAP files of ours, read by Foxglove's own reader (mcap, mcap-ros2-support)."""

from __future__ import annotations

import io
from typing import Any

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
