"""YAML: a robot as the files in ``robots/`` are written."""

from __future__ import annotations

import yaml

from stairwright.robot.description import Robot


def robot_yaml(robot: Robot) -> bytes:
    """The whole document, a short list or mapping on one line; reads back as it was."""
    data = robot.model_dump(mode="json", exclude_none=True)
    text = yaml.safe_dump(
        data, sort_keys=False, allow_unicode=True, default_flow_style=None, width=100
    )
    return text.encode()
