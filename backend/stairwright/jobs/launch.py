"""Start the process that workers are forked from, as early as can be.

It takes a second or two to import and load what workers need; a server that launches it before its
own imports has workers as soon as it can answer. Nothing heavy may be imported here.
"""

from __future__ import annotations

import multiprocessing
from multiprocessing import forkserver
from multiprocessing.context import ForkServerContext

PRELOAD = "stairwright.jobs.preload"


def context() -> ForkServerContext:
    """How worker processes are made."""
    made = multiprocessing.get_context("forkserver")
    made.set_forkserver_preload([PRELOAD])
    return made


def launch() -> None:
    """Start the fork server, without waiting until it is ready."""
    context()
    forkserver.ensure_running()
