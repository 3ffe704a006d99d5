"""Leaves: compiled functions that borrow arrays."""

from __future__ import annotations

import importlib
import inspect
import os
import pkgutil
import subprocess
import sys
from collections.abc import Iterator

import numpy as np
import pytest
from numba.core.dispatcher import Dispatcher
from numba.core.errors import NumbaError
from numpy.typing import NDArray

import stairwright
from stairwright.compiled import leaf

# Plans, a verdict and a rollout, then again: of what that makes hardly an array is left (a search
# that nobody waits for any more may still hold some).
_TWICE = """
import gc

from numba.core.runtime import rtsys

import stairwright as sw

def alive():
    gc.collect()
    stats = rtsys.get_allocation_stats()
    return stats.mi_alloc - stats.mi_free, stats.mi_alloc

def work():
    sw.rollout(sw.plan("single-stair-030"))
    sw.plan("single-stair-030", method="critical")
    sw.plan({"points": [[-1.2, 0], [0, 0], [0, 1.3], [1.2, 1.3]]})

work()
before, made = alive()
work()
after, more = alive()
assert more - made > 1_000, (made, more)
assert after - before < 500, (before, after)
"""


def test_a_leaf_borrows_what_it_is_given() -> None:
    @leaf
    def double(a: NDArray[np.float64]) -> None:
        for i in range(len(a)):
            a[i] *= 2.0

    a = np.array([1.0, 2.0])
    double(a)
    assert a.tolist() == [2.0, 4.0]


def test_a_leaf_that_makes_an_array_is_refused() -> None:
    @leaf
    def make(n: int) -> float:
        return float(np.zeros(n).sum())

    with pytest.raises(NumbaError, match="zeros"):
        make(3)


def _dispatchers() -> Iterator[Dispatcher]:
    """All compiled functions of the package."""
    for found in pkgutil.walk_packages(stairwright.__path__, "stairwright."):
        if not found.name.endswith("__main__"):
            for item in vars(importlib.import_module(found.name)).values():
                if isinstance(item, Dispatcher) and item.py_func.__module__ == found.name:
                    yield item


def _is_of_numbers(function: Dispatcher) -> bool:
    signature = inspect.signature(function.py_func)
    given = {parameter.annotation for parameter in signature.parameters.values()}
    numbers = {"float", "int", "bool", "np.uint64", "np.int64", "tuple[float, float]"}
    return signature.return_annotation in numbers and given <= numbers | {
        "Leg",
        "Planar",
        "Lattice",
    }


def _called(function: Dispatcher) -> Iterator[Dispatcher]:
    """Compiled functions that it calls, and those that inlined ones call in it."""
    for name in function.py_func.__code__.co_names:
        called = function.py_func.__globals__.get(name)
        if isinstance(called, Dispatcher):
            if called.targetoptions.get("inline") == "always":
                yield from _called(called)
            else:
                yield called


def test_leaves_call_only_leaves_and_functions_of_numbers() -> None:
    leaves = [one for one in _dispatchers() if one.targetoptions.get("_nrt") is False]
    assert len(leaves) > 20  # that they are found at all
    for one in leaves:
        for called in _called(one):
            assert called in leaves or _is_of_numbers(called), (one.py_func, called.py_func)


def test_no_compiled_function_keeps_an_array_for_good() -> None:
    subprocess.run(
        [sys.executable, "-c", _TWICE], env=os.environ | {"NUMBA_NRT_STATS": "1"}, check=True
    )
