"""The first thing that a worker process does."""

from __future__ import annotations

import ctypes
import gc
import os
import resource
import signal
import sys
from dataclasses import dataclass

from .board import read_board

_PR_SET_PDEATHSIG = 1


@dataclass(frozen=True)
class Limits:
    """What a worker may use.

    Attributes:
        memory: Address space beyond what it has at the start, MiB; 0 for no limit.
        nice: Added to its scheduling niceness: workers that nobody waits for step back.
        sealed: It can open no file, socket or process and write to no file.
    """

    memory: int = 0
    nice: int = 0
    sealed: bool = False


def initialise(limits: Limits, board: str) -> None:
    """Set the limits and the signals; `board` is the path of the pool's board."""
    read_board(board)
    gc.freeze()  # what was imported before the fork; a look at all of it takes longer than a plan
    signal.signal(signal.SIGTERM, signal.SIG_DFL)  # at once, even inside compiled code
    die_with_parent()
    if limits.nice:
        os.nice(limits.nice)
    if limits.memory:
        _limit(resource.RLIMIT_AS, _address_space() + limits.memory * 2**20)
    if limits.sealed:
        _seal()


def die_with_parent() -> None:
    """Where the system can (Linux), end at once when the parent is gone, whatever we are at."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)


def _seal() -> None:
    import trimesh  # noqa: F401 - no file can be opened later, not even a module's

    from . import uploads

    uploads.rehearse()
    _limit(resource.RLIMIT_FSIZE, 0)
    _limit(resource.RLIMIT_NPROC, 0)
    _limit(resource.RLIMIT_NOFILE, _first_free_descriptor())


def _first_free_descriptor() -> int:
    descriptor = os.open(os.devnull, os.O_RDONLY)
    os.close(descriptor)
    return descriptor


def _address_space() -> int:
    """Bytes of address space in use now."""
    try:
        with open("/proc/self/statm", encoding="ascii") as file:  # noqa: PTH123
            return int(file.read().split()[0]) * resource.getpagesize()
    except OSError:
        return 2 * 2**30  # no Linux: a guess on the high side


def _limit(what: int, value: int) -> None:
    _, hard = resource.getrlimit(what)
    if hard != resource.RLIM_INFINITY:
        value = min(value, hard)
    resource.setrlimit(what, (value, value))
