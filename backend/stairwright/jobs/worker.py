"""The inside of a worker process: what it sets up, and how it works off its tasks."""

from __future__ import annotations

import contextlib
import ctypes
import errno
import gc
import os
import pickle
import resource
import select
import signal
import socket
import struct
import sys
import traceback
from dataclasses import dataclass
from typing import Any

from stairwright.resources import address_space

from .memory import give_memory_back

LENGTH = struct.Struct("!Q")  # before each message: its length without this
RESTLESS = 5.0  # s without a task until a worker gives back memory that it does not use
_PR_SET_PDEATHSIG = 1
_OOM_SCORE = "500"  # of -1000 (never ended for want of memory) to 1000 (first of all)


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


def serve(channel: socket.socket, limits: Limits) -> None:
    """Answer every task that comes until the other side closes the channel."""
    _initialise(limits)
    waiting = select.poll()
    waiting.register(channel, select.POLLIN)
    with channel, channel.makefile("rb") as tasks:
        while True:
            if not waiting.poll(RESTLESS * 1000):
                gc.collect()
                give_memory_back()
            head = tasks.read(LENGTH.size)
            if len(head) < LENGTH.size:
                return
            channel.sendall(_outcome(tasks.read(*LENGTH.unpack(head))))


def packed(message: Any) -> bytes:
    """A message as it goes over the channel."""
    content = pickle.dumps(message)
    return LENGTH.pack(len(content)) + content


def _outcome(task: bytes) -> bytes:
    """Whether a function returned, and what it returned or raised."""
    try:
        function, args = pickle.loads(task)  # noqa: S301 - from the process that started this one
        return packed((True, function(*args)))
    except Exception as error:  # noqa: BLE001 - raised again on the other side
        if _for_want_of_memory(error):
            return packed((False, MemoryError()))
        error.add_note(f"In a worker:\n{traceback.format_exc()}")
        try:
            return packed((False, error))
        except Exception:  # noqa: BLE001 - not every exception can travel
            return packed((False, RuntimeError(traceback.format_exc())))


def _for_want_of_memory(error: Exception) -> bool:
    """Libraries say it in several ways: as themselves, as the system's error, as C++'s."""
    if isinstance(error, OSError):
        return error.errno == errno.ENOMEM
    words = ("bad_alloc", "can't start new thread", "Could not allocate memory")
    return isinstance(error, MemoryError) or (
        isinstance(error, RuntimeError) and any(word in str(error) for word in words)
    )


def _initialise(limits: Limits) -> None:
    gc.freeze()  # what was imported before the fork; a look at all of it takes longer than a plan
    signal.signal(signal.SIGTERM, signal.SIG_DFL)  # at once, even inside compiled code
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C ends the service, which ends us
    die_with_parent()
    _go_first()
    if limits.nice:
        os.nice(limits.nice)
    if limits.memory:
        _limit(resource.RLIMIT_AS, address_space() + limits.memory * 2**20)
    if limits.sealed:
        _seal()


def die_with_parent() -> None:
    """Where the system can (Linux), end at once when the parent is gone, whatever we are at."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)


def _go_first() -> None:
    """When the machine runs out of memory, the system ends a worker, not the service."""
    with contextlib.suppress(OSError), open("/proc/self/oom_score_adj", "w") as file:  # noqa: PTH123
        file.write(_OOM_SCORE)


def _seal() -> None:
    import trimesh  # noqa: F401 - no file can be opened later, not even a module's

    from . import robot_uploads, uploads

    uploads.rehearse()
    robot_uploads.rehearse()
    _limit(resource.RLIMIT_FSIZE, 0)
    _limit(resource.RLIMIT_NPROC, 0)
    _limit(resource.RLIMIT_NOFILE, _first_free_descriptor())


def _first_free_descriptor() -> int:
    descriptor = os.open(os.devnull, os.O_RDONLY)
    os.close(descriptor)
    return descriptor


def _limit(what: int, value: int) -> None:
    _, hard = resource.getrlimit(what)
    if hard != resource.RLIM_INFINITY:
        value = min(value, hard)
    resource.setrlimit(what, (value, value))
