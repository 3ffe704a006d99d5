"""Imported once by the process that workers are forked from, so that each starts warm.

This module does work at import, because that is when the fork server can do it: it imports what
workers need, and keeps numeric libraries to one thread each. What planning needs comes first, since
somebody may wait for a plan; what only rollouts need comes when the workers for plans are there.
"""

from __future__ import annotations

import os
import signal

for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_variable] = "1"

from stairwright.jobs import warming  # noqa: E402 - numeric libraries read the variables
from stairwright.jobs.stage import Stage  # noqa: E402

TICK = 0.5  # s between looks whether the service is still there
_PARENT = os.getppid()


def _end_if_orphaned(*_: object) -> None:
    if os.getppid() != _PARENT:
        os._exit(1)


# By itself the fork server ends when the last worker has, and a worker when its task is done. This
# ends all of them at once when the service is killed: workers go with the fork server.
signal.signal(signal.SIGALRM, _end_if_orphaned)
signal.setitimer(signal.ITIMER_REAL, TICK, TICK)


def _warm_rollouts(*_: object) -> None:
    """At the first tick: by then the workers that somebody may wait for have been forked."""
    signal.signal(signal.SIGALRM, _end_if_orphaned)
    warming.warm_rollouts()


def _warm_plans() -> None:
    """One small plan brings everything into memory."""
    stage = Stage.inherited()
    stage.tell("loading the planner")
    warming.warm_plans()
    stage.tell("starting workers")


_warm_plans()
signal.signal(signal.SIGALRM, _warm_rollouts)
signal.setitimer(signal.ITIMER_REAL, TICK, TICK)
