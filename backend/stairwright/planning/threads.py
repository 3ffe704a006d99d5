"""Two threads for searches that are asked at once: compiled searches leave Python alone.

Where every core has a plan of its own to make, `one_by_one` lets each do without them: what is
searched ahead of need would only keep other plans waiting. The answers are the same.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Collection, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager
from contextvars import ContextVar
from functools import lru_cache
from typing import Any, TypeVar

T = TypeVar("T")
R = TypeVar("R")

_THREADS = 2
_work = threading.local()  # what the thread is doing: `over` is set once nobody waits for it


class Abandoned(Exception):
    """Nobody waits for this work any more."""


class _AtOnce(Executor):
    """Does what it is given before it goes on."""

    def submit(self, fn: Callable[..., R], /, *args: Any, **kwargs: Any) -> Future[R]:
        """The finished work."""
        done: Future[R] = Future()
        try:
            done.set_result(fn(*args, **kwargs))
        except BaseException as error:  # noqa: BLE001 - who asks for the result gets it
            done.set_exception(error)
        return done


_at_once: ContextVar[Executor | None] = ContextVar("at_once", default=None)


@contextmanager
def one_by_one() -> Iterator[None]:
    """Within this, searches are made one after another in this thread, and only when needed."""
    token = _at_once.set(_AtOnce())
    try:
        yield
    finally:
        _at_once.reset(token)


def search_threads() -> Executor:
    """Threads that live as long as the process: those of a search keep the memory it needs.

    What runs on them must not wait for them.
    """
    return _at_once.get() or _pool(os.getpid())


def in_this_thread() -> Executor:
    """Makes what it is given one after another, in the thread that gives it."""
    return _AtOnce()


@contextmanager
def race(pool: Executor, ask: Callable[[T], R], items: Collection[T]) -> Iterator[Iterator[R]]:
    """Answers in the order of `items`, worked on at once; those not taken in the end are abandoned.

    Work that has begun goes on until it next calls `still_wanted`. A single item needs no thread.
    """
    if len(items) == 1 or isinstance(pool, _AtOnce):
        yield map(ask, items)
        return
    over = threading.Event()

    def work(item: T) -> R:
        _work.over = over
        try:
            return ask(item)
        finally:
            _work.over = None

    try:
        yield pool.map(work, items)
    finally:
        over.set()


def still_wanted() -> None:
    """To be called between the steps of long work.

    Raises:
        Abandoned: If nobody waits for what this thread does.
    """
    over = getattr(_work, "over", None)
    if over is not None and over.is_set():
        raise Abandoned


@lru_cache(maxsize=1)
def _pool(_process: int) -> Executor:
    return ThreadPoolExecutor(_THREADS, "search")
