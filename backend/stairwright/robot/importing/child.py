"""The inside of the process that reads a robot file: limits first, then the file."""

from __future__ import annotations

import json
import os
import pickle
import resource
import sys

from stairwright.errors import InputError
from stairwright.resources import address_space
from stairwright.robot.description import Robot

from .rehearsal import rehearse

_CPU = 20  # s
_MEMORY = 2 * 2**30  # bytes beyond what it has at the start


def main() -> None:
    """Read a task from standard input, write the answer to standard output."""
    from .read import read_file

    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what libraries print is no answer
    name, content, files, options, documents = pickle.load(sys.stdin.buffer)  # noqa: S301 - ours
    known = [Robot.model_validate(document) for document in documents]
    rehearse(meshes=content[:4] == b"PK\x03\x04" or bool(files))
    _seal()
    try:
        answer = read_file(content, name, options, known, files).model_dump(mode="json")
    except InputError as error:
        answer = {"error": error.message, "field": list(error.field)}
    except MemoryError:
        answer = {"error": "takes too much memory to read", "field": ["file"]}
    answers.write(json.dumps(answer).encode())
    answers.close()


def _seal() -> None:
    """From here on it opens no file, writes to none and starts nothing."""
    free = os.open(os.devnull, os.O_RDONLY)
    os.close(free)
    for what, value in (
        (resource.RLIMIT_AS, address_space() + _MEMORY),
        (resource.RLIMIT_CPU, _CPU),
        (resource.RLIMIT_FSIZE, 0),
        (resource.RLIMIT_NPROC, 0),
        (resource.RLIMIT_NOFILE, free),
    ):
        _, hard = resource.getrlimit(what)
        value = value if hard == resource.RLIM_INFINITY else min(value, hard)
        resource.setrlimit(what, (value, value))
