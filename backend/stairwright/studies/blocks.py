"""Cells as JSON for whoever draws them: one list a variable. orjson makes null of NaN."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from .store import ResultStore
from .variables import PENDING, VARIABLES, Record

MOST = 2000  # cells of a block
Block = dict[str, list[Any]]


def block_of(records: Mapping[int, Record]) -> Block:
    """A block of these cells: their numbers as `cell`, then the variables."""
    block: Block = {"cell": list(records)}
    for name in VARIABLES:
        block[name] = [record[name] for record in records.values()]
    return block


def blocks_of(store: ResultStore) -> Iterator[Block]:
    """All cells that a store knows."""
    known = np.flatnonzero(store.states != PENDING).tolist()
    for start in range(0, len(known), MOST):
        yield block_of(store.records(known[start : start + MOST]))


def joined(blocks: Iterator[Block]) -> Block:
    """One block of several."""
    whole: Block = {"cell": [], **{name: [] for name in VARIABLES}}
    for block in blocks:
        for name, values in block.items():
            whole[name] += values
    return whole
