"""Two threads for searches that are asked at once: compiled searches leave Python alone."""

from __future__ import annotations

import os
from concurrent.futures import Executor, ThreadPoolExecutor
from functools import lru_cache

_THREADS = 2


def search_threads() -> Executor:
    """Threads that live as long as the process: those of a search keep the memory it needs.

    What runs on them must not wait for them.
    """
    return _pool(os.getpid())


@lru_cache(maxsize=1)
def _pool(_process: int) -> Executor:
    return ThreadPoolExecutor(_THREADS, "search")
