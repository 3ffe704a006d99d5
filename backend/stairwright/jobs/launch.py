"""Start the process that workers are forked from, as early as can be.

It takes a second or two to import and load what workers need; a server that launches it before its
own imports has workers as soon as it can answer. Nothing heavy may be imported here.
"""

from __future__ import annotations

import multiprocessing
from multiprocessing import forkserver
from multiprocessing.context import ForkServerContext

from .stage import Stage

PRELOAD = "stairwright.jobs.preload"
_stage: Stage | None = None


def context() -> ForkServerContext:
    """How worker processes are made."""
    made = multiprocessing.get_context("forkserver")
    made.set_forkserver_preload([PRELOAD])
    return made


def launch() -> None:
    """Start the fork server, without waiting until it is ready; it tells what it is at."""
    global _stage
    _stage = Stage.create()
    context()
    forkserver.ensure_running()


def told() -> None:
    """Nobody asks any more what the fork server is at."""
    if _stage is not None:
        _stage.close()


def stage() -> str:
    """What the fork server is at, if it was launched here."""
    return "" if _stage is None else _stage.text()
