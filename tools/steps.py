"""Steps of the set-up: each stamps what it read, and runs again when that has changed."""

from __future__ import annotations

import contextlib
import hashlib
import time
from collections.abc import Iterable, Iterator
from pathlib import Path

from .places import ROOT, STATE
from .running import say


def digest(paths: Iterable[Path], *facts: object) -> str:
    """A hash of the files' names and contents and of `facts`."""
    total = hashlib.sha256(repr(facts).encode())
    for path in sorted(paths):
        content = hashlib.sha256(path.read_bytes()).hexdigest()
        total.update(f"{path.relative_to(ROOT)} {content}\n".encode())
    return total.hexdigest()


@contextlib.contextmanager
def step(title: str, stamp: Path, wanted: str, *, done: bool = True) -> Iterator[bool]:
    """Yield whether the step has to run; stamp it when it went well.

    `done` says whether what the step makes is still there.
    """
    if done and stamp.is_file() and stamp.read_text() == wanted:
        yield False
        return
    stamp.unlink(missing_ok=True)
    say(f"{title} ...")
    start = time.monotonic()
    yield True
    stamp.parent.mkdir(parents=True, exist_ok=True)
    stamp.write_text(wanted)
    say(f"{title}: done in {time.monotonic() - start:.1f} s")


@contextlib.contextmanager
def one_at_a_time() -> Iterator[None]:
    """Two calls in one checkout must not set up the same folder at once."""
    import fcntl

    STATE.mkdir(exist_ok=True)
    with (STATE / "lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            say("Waiting for another ./dev in this folder to finish its set-up ...")
            fcntl.flock(lock, fcntl.LOCK_EX)
        yield
