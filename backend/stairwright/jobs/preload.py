"""Imported once by the process that workers are forked from, so that each starts warm.

This module does work at import, because that is when the fork server can do it: it imports what
workers need, loads the compiled kernels, and keeps numeric libraries to one thread each.
"""

from __future__ import annotations

import contextlib
import os
import signal

for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_variable] = "1"

_PARENT = os.getppid()


def _end_if_orphaned(*_: object) -> None:
    if os.getppid() != _PARENT:
        os._exit(1)


# By itself the fork server ends when the last worker has, and a worker when its task is done. This
# ends all of them at once when the service is killed: workers go with the fork server.
signal.signal(signal.SIGALRM, _end_if_orphaned)
signal.setitimer(signal.ITIMER_REAL, 0.5, 0.5)

# A failure here is no reason to have no workers: it will show again, with a traceback in the log,
# in the first task that needs what failed.
with contextlib.suppress(Exception):
    from stairwright.jobs import work

    work.warm()
