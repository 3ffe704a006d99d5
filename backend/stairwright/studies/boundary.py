"""Studies with a boundary: rows are searched, coarse ones first, others from their neighbours.

That each row changes once is checked, not trusted: a share of the cells off the border is asked as
well. A row that contradicts is asked cell by cell, and its neighbours are checked too.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from .border import flips, foretell, low_count, next_cells
from .document import Study
from .fill import Meter, Report
from .grid import levels
from .serial import Engine, Finished, Stopped
from .store import ResultStore
from .variables import DONE, PENDING, Record

CHECKED = 0.1  # of the rows have a cell off their border asked
_PER_ROW = 2.5  # cells that a row takes, before that is known

Ints = NDArray[np.int64]


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
        self._where: dict[int, tuple[int, int]] = {}

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
    search = _Search(store, engine, report, stopped)
    all(search.ask(wave) for wave in search.waves())


class _Search:
    def __init__(
        self, store: ResultStore, engine: Engine, report: Report | None, stopped: Stopped
    ) -> None:
        self.rows = Rows(store.study)
        self._store, self._engine, self._stopped = store, engine, stopped
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
                self._store.write(finished)
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
            yield from self._settled(level.tolist(), done)
            done += level.tolist()
            share = len(self._stored) / len(done)
            self._meter.total = max(len(self._stored), round(share * len(self.rows.cells)))
        yield from self._checks()
        self._meter.total = self._meter.done
        self._meter.tell({})

    def _settled(self, rows: list[int], done: list[int]) -> Iterator[list[tuple[int, int]]]:
        """Find the borders of `rows`, starting from those of the rows that are `done`."""
        n, rising = self.rows.n, self.rows.rising
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
        """Cells off the border; of rows that contradict all cells, then checks of neighbours."""
        random = np.random.default_rng(0)
        rows = self.rows
        count = max(1, round(CHECKED * len(rows.cells)))
        wave = self._samples(random.permutation(len(rows.cells))[:count].tolist(), random)
        suspected: set[int] = set()
        while wave:
            yield wave
            yield from self._settled(list(range(len(rows.cells))), [])
            rising = rows.rising
            bad = [
                row
                for row, known in enumerate(rows.known)
                if row not in suspected and _contradicts(known, rising)
            ]
            suspected |= set(bad)
            yield [(r, k) for r in bad for k in range(rows.n + 1) if k not in rows.known[r]]
            wave = self._where_neighbours_contradict(bad, suspected)

    def _where_neighbours_contradict(
        self, bad: list[int], suspected: set[int]
    ) -> list[tuple[int, int]]:
        """The same cells in the neighbours of rows that contradict: two in each band of them."""
        wave: set[tuple[int, int]] = set()
        for row in bad:
            changes = flips(self.rows.known[row])
            marks = {k for (_, a), (b, _) in itertools.pairwise(changes) for k in ((a + b) // 2, a)}
            for near in self._neighbours(row):
                known = self.rows.known[int(near)]
                if int(near) not in suspected:
                    wave |= {(int(near), k) for k in marks if k not in known}
        return sorted(wave)

    def _neighbours(self, row: int) -> Ints:
        distance = np.abs(self.rows.places - self.rows.places[row]).sum(axis=1)
        return np.flatnonzero((distance > 0) & (distance <= 1.0))

    def _samples(self, rows: list[int], random: np.random.Generator) -> list[tuple[int, int]]:
        """A cell that was not asked yet in each row."""
        out = []
        for row in rows:
            free = [k for k in range(self.rows.n + 1) if k not in self.rows.known[row]]
            if free:
                out.append((row, int(random.choice(free))))
        return out


def _contradicts(known: Mapping[int, bool], rising: bool | None) -> bool:
    """Whether a row changes more than once, or the other way than most rows."""
    changes = flips(known)
    wrong_way = bool(changes) and rising is not None and known[max(known)] != rising
    return len(changes) > 1 or wrong_way


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
    search = _Search(store, _Nobody(), None, lambda: True)
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
