"""Studies with a boundary: rows are searched, coarse ones first, others from their neighbours.

That each row changes once is checked, not trusted: in a share of the rows a cell off the border is
asked as well, mostly one that should pass, for a border frays on that side. Where it does not pass,
the border before it is found, and the neighbours are checked in the same place.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence

import numpy as np

from stairwright.arrays import Ints

from .border import border, flips, foretell, low_count, next_cells
from .document import Study
from .grid import levels
from .progress import Meter, Report
from .serial import Engine, Finished, Stopped
from .store import ResultStore
from .variables import DONE, PENDING, Record
from .writer import Writer

CHECKED = 0.25  # of the rows have a cell off their border asked
_NEAR, _FRINGE = 0.7, 0.15  # share of these close to the border; how close, of the axis
_PER_ROW = 2.5  # cells that a row takes, before that is known


def passes(record: Record) -> bool:
    """The outcome that a boundary is of: a plan, a rollout that succeeds, trials that all do."""
    if record["state"] != DONE or not record["feasible"]:
        return False
    return bool(record["success"] == record["trials"])


class Rows:
    """The rows of a study and what is known of them."""

    def __init__(self, study: Study) -> None:
        axis = study.boundary_axis
        assert axis is not None
        self.axis = study.axes.index(axis)
        self.n = len(axis.points) - 1
        shape = list(study.shape)
        shape.pop(self.axis)
        self.shape = tuple(shape)
        numbers = np.arange(study.cells).reshape(study.shape)
        self.cells: Ints = np.moveaxis(numbers, self.axis, -1).reshape(-1, self.n + 1)
        self.places = np.array(list(np.ndindex(*self.shape)), float).reshape(len(self.cells), -1)
        self.known: list[dict[int, bool]] = [{} for _ in self.cells]

    def learn(self, row: int, k: int, verdict: bool) -> None:
        """A cell's verdict."""
        self.known[row][k] = verdict

    @property
    def levels(self) -> list[Ints]:
        """Rows of a coarse picture, then those of finer ones."""
        level = np.full(self.shape, 10**6, np.int64)
        for k, length in enumerate(self.shape):
            each = levels(length)
            if each.max() > 0:
                spread = [1] * len(self.shape)
                spread[k] = -1
                level = np.minimum(level, (each - each.max()).reshape(spread))
        flat = level.ravel()
        return [np.flatnonzero(flat == value) for value in sorted(set(flat.tolist()), reverse=True)]

    @property
    def rising(self) -> bool | None:
        """Whether most rows that change pass at their high end; None if none changes."""
        votes = [known[max(known)] for known in self.known if flips(known)]
        return None if not votes else sum(votes) * 2 >= len(votes)


def fill_boundary(
    store: ResultStore, engine: Engine, report: Report | None, stopped: Stopped
) -> None:
    """Find the border of every row, and check that there is only one."""
    with Writer(store) as writer:
        search = _Search(store, engine, writer, report, stopped)
        all(search.ask(wave) for wave in search.waves())


class _Search:
    def __init__(
        self,
        store: ResultStore,
        engine: Engine,
        writer: Writer,
        report: Report | None,
        stopped: Stopped,
    ) -> None:
        self.rows = Rows(store.study)
        self._store, self._engine, self._stopped = store, engine, stopped
        self._writer = writer
        self._stored = _stored_verdicts(store)
        total = round(_PER_ROW * len(self.rows.cells))
        self._meter = Meter(len(self._stored), max(total, len(self._stored)), report)
        self._meter.tell({})

    def ask(self, wave: list[tuple[int, int]]) -> bool:
        """Learn the verdicts of (row, k); False if it was stopped before that was done."""
        places = {int(self.rows.cells[row, k]): (row, k) for row, k in wave}
        new = [cell for cell in places if cell not in self._stored]
        if new:
            for finished in self._engine.evaluate(self._store.study, new, self._stopped):
                self._writer.add(finished)
                self._stored |= {cell: passes(record) for cell, record in finished.items()}
                self._meter.tell(finished)
        for cell, (row, k) in places.items():
            if cell not in self._stored:
                return False
            self.rows.learn(row, k, self._stored[cell])
        return True

    def waves(self) -> Iterator[list[tuple[int, int]]]:
        """What to ask, each wave once the one before it is answered."""
        done: list[int] = []
        for level in self.rows.levels:
            yield from self._settled(level.tolist(), done, self.rows.rising)
            done += level.tolist()
            share = len(self._stored) / len(done)
            self._meter.total = max(len(self._stored), round(share * len(self.rows.cells)))
        yield from self._checks()
        self._meter.total = self._meter.done
        self._meter.tell({})

    def _settled(
        self, rows: list[int], done: list[int], rising: bool | None
    ) -> Iterator[list[tuple[int, int]]]:
        """Find the borders of `rows`, starting from those of the rows that are `done`."""
        n = self.rows.n
        guesses: dict[int, float] = {}
        if done and rising is not None:
            places = self.rows.places[done]
            borders = np.array([low_count(self.rows.known[r], n, rising) for r in done], float)
            for row in rows:
                guesses[row] = foretell(self.rows.places[row], places, borders, n)
        while True:
            wave = [
                (row, k)
                for row in rows
                for k in next_cells(self.rows.known[row], n, rising, guesses.get(row))
            ]
            if not wave:
                return
            yield wave

    def _checks(self) -> Iterator[list[tuple[int, int]]]:
        """Cells off the border; where they contradict it, the border before them is found."""
        random = np.random.default_rng(0)
        rows = self.rows
        count = math.ceil(CHECKED * len(rows.cells))
        chosen = random.permutation(len(rows.cells))[:count].tolist()
        wave = [pair for row in chosen for pair in self._sample(row, random)]
        suspected: set[int] = set()
        while wave:
            yield wave
            rising = rows.rising
            yield from self._settled(list(range(len(rows.cells))), [], rising)
            bad = [
                row
                for row, known in enumerate(rows.known)
                if row not in suspected and not border(known, rising).monotone
            ]
            suspected |= set(bad)
            wave = self._beside(bad, suspected)

    def _sample(self, row: int, random: np.random.Generator) -> list[tuple[int, int]]:
        """A cell that was not asked yet: rather one that should pass, a little off the border."""
        known, n = self.rows.known[row], self.rows.n
        found = border(known, self.rows.rising)
        free = [k for k in range(n + 1) if k not in known]
        if found.inside is not None and found.beyond is not None and random.random() < _NEAR:
            reach = max(2, round(_FRINGE * n))
            ahead = 1 if found.inside > found.beyond else -1
            fringe = {found.inside + ahead * step for step in range(1, reach + 1)}
            free = [k for k in free if k in fringe] or free
        return [(row, int(random.choice(free)))] if free else []

    def _beside(self, bad: list[int], suspected: set[int]) -> list[tuple[int, int]]:
        """In the neighbours of rows that contradict, the cells that did."""
        wave: set[tuple[int, int]] = set()
        for row in bad:
            changes = flips(self.rows.known[row])
            marks = {k for (_, a), (b, _) in itertools.pairwise(changes) for k in (a, b)}
            for near in self._neighbours(row):
                known = self.rows.known[int(near)]
                if int(near) not in suspected:
                    wave |= {(int(near), k) for k in marks if k not in known}
        return sorted(wave)

    def _neighbours(self, row: int) -> Ints:
        distance = np.abs(self.rows.places - self.rows.places[row]).sum(axis=1)
        return np.flatnonzero((distance > 0) & (distance <= 1.0))


def _stored_verdicts(store: ResultStore) -> dict[int, bool]:
    """Verdicts of all cells that the store has, by their numbers."""
    places = np.nonzero(store.states != PENDING)
    if not len(places[0]):
        return {}
    cells = np.ravel_multi_index(places, store.study.shape).tolist()
    names = ("state", "feasible", "success", "trials")
    columns = {name: store.read(name, places).tolist() for name in names}
    return {
        cell: passes({name: column[k] for name, column in columns.items()})
        for k, cell in enumerate(cells)
    }


def searched_rows(store: ResultStore) -> tuple[Rows, bool]:
    """The rows as the search leaves them with what the store knows, and whether that is all."""
    search = _Search(store, _Nobody(), Writer(store), None, lambda: True)
    complete = all(search.ask(wave) for wave in search.waves())
    return search.rows, complete


class _Nobody:
    """An engine that is never asked: the search is stopped where it would be."""

    def evaluate(self, study: Study, cells: Sequence[int], stopped: Stopped) -> Iterator[Finished]:
        """Nothing."""
        _ = study, cells, stopped
        return iter(())

    def close(self) -> None:
        """Nothing was started."""
