"""Servers forked from a process that has imported what they need, which is half of a start.

They are `python -m stairwright serve` in all else: session, environment, main module, exit.
"""

from __future__ import annotations

import atexit
import json
import os
import runpy
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any


def start(arguments: Sequence[str], env: Mapping[str, str], log: Path) -> int:
    """The process of `stairwright` with these arguments."""
    stem = _stem()
    assert stem.stdin is not None
    assert stem.stdout is not None
    order = {"arguments": [*arguments], "env": {**env}, "log": str(log)}
    stem.stdin.write(json.dumps(order) + "\n")
    stem.stdin.flush()
    return int(stem.stdout.readline())


@cache
def _stem() -> subprocess.Popen[str]:
    """The process that they are forked from; it ends with this one."""
    pipe = subprocess.PIPE
    stem = subprocess.Popen([sys.executable, __file__], stdin=pipe, stdout=pipe, text=True)

    def end() -> None:
        stem.communicate()

    atexit.register(end)
    return stem


def _import_all() -> None:
    """Starts no thread: none would be there after a fork."""
    import alembic.command  # noqa: F401
    import uvicorn.lifespan.on
    import uvicorn.loops.auto
    import uvicorn.protocols.http.httptools_impl
    import uvicorn.protocols.websockets.websockets_sansio_impl  # noqa: F401

    import stairwright.api.app
    import stairwright.api.connections
    import stairwright.api.logs
    import stairwright.api.server
    import stairwright.cli
    import stairwright.scene.session  # noqa: F401


def _serve(order: dict[str, Any]) -> None:
    os.setsid()
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    output = os.open(order["log"], os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)
    for stream, replaced in ((os.open(os.devnull, os.O_RDONLY), 0), (output, 1), (output, 2)):
        os.dup2(stream, replaced)
    os.environ.clear()
    os.environ.update(order["env"])
    sys.argv = ["stairwright", *order["arguments"]]
    runpy.run_module("stairwright", run_name="__main__", alter_sys=True)


def _main() -> None:
    _import_all()
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # whoever asked waits for them; none stays
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # of the terminal: the tests end, and this then
    for line in iter(sys.stdin.readline, ""):
        pid = os.fork()
        if not pid:
            signal.signal(signal.SIGINT, signal.SIG_DFL)
            _serve(json.loads(line))
            return
        print(pid, flush=True)


if __name__ == "__main__":
    _main()
