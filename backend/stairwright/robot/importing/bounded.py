"""Read a robot file in a process of its own, which may use little time and memory and no files."""

from __future__ import annotations

import json
import logging
import os
import pickle
import subprocess
import sys
from collections.abc import Mapping, Sequence
from typing import Any

from stairwright.errors import InputError
from stairwright.robot.description import Robot

from .report import Imported

DEADLINE = 30.0  # s
logger = logging.getLogger(__name__)
_START = "import sys, pickle; sys.path[:] = {path!r}; from {module} import main; main()"


def import_bounded(
    name: str,
    content: bytes,
    files: Mapping[str, bytes],
    options: Mapping[str, Any],
    known: Sequence[Robot] = (),
) -> Imported:
    """The robot in an upload, as `read`, with limits on the reader.

    Raises:
        InputError: If it is no robot, or takes too long or too much memory.
    """
    documents = [robot.model_dump(mode="json") for robot in known]
    task = pickle.dumps((name, content, dict(files), dict(options), documents))
    command = _START.format(path=sys.path, module=f"{__package__}.child")
    try:
        done = subprocess.run(
            [sys.executable, "-c", command],
            input=task,
            capture_output=True,
            timeout=DEADLINE,
            check=False,
            env={**os.environ, "PYTHONWARNINGS": "ignore"},
        )
    except subprocess.TimeoutExpired:
        raise InputError(f"takes longer than {DEADLINE:g} s to read", ("file",)) from None
    try:
        answer = json.loads(done.stdout)
    except ValueError:
        logger.warning("reading a robot ended with %s: %s", done.returncode, done.stderr[-2000:])
        raise InputError("takes too much time or memory to read", ("file",)) from None
    if "error" in answer:
        raise InputError(answer["error"], tuple(answer["field"]))
    return Imported.model_validate(answer)
