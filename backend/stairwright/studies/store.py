"""Results on disk: one Zarr group a study, filled chunk by chunk by one writer.

A cell counts only once its `state` is written, which comes last, and each chunk is a file that is
renamed into place: whoever dies, what was written before stays whole.
"""

from __future__ import annotations

import contextlib
import fcntl
import math
import shutil
import time
import warnings
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import orjson
import zarr
from numpy.typing import NDArray
from zarr.errors import GroupNotFoundError, NodeTypeValidationError, ZarrUserWarning

from stairwright.arrays import Ints32
from stairwright.documents import parse
from stairwright.errors import InputError

from .document import Study, study_id
from .targets import target
from .variables import DONE, FAILED, PENDING, REFUSED, VARIABLES, Record

_CHUNK = 4096  # cells; a batch touches few chunks, and none takes long to write
_MOST_CHUNKS = 64
_SCHEMA = "stairwright/study-results/1"
SUFFIX = ".zarr"

_STATE_LAST = (*(name for name in VARIABLES if name != "state"), "state")

Places = tuple[NDArray[np.intp], ...]


class ResultStore:
    """The results of one study so far. One writer at a time; readers need no lock."""

    def __init__(self, path: Path) -> None:
        """Open what is there.

        Raises:
            InputError: If there is no study's result.
        """
        self.path = path
        try:
            self._group = zarr.open_group(path, mode="r+", use_consolidated=False)
            attributes: Mapping[str, Any] = dict(self._group.attrs)
        except (GroupNotFoundError, NodeTypeValidationError, ValueError, OSError) as error:
            raise InputError(f"{path} holds no results of a study") from error
        if attributes.get("schema") != _SCHEMA:
            raise InputError(f"{path} holds no results of a study")
        self.id = str(attributes["id"])
        self.engine = str(attributes["engine"])
        self.created = float(attributes["created"])
        self.study = parse(Study, orjson.loads(attributes["study"]))
        new = [name for name in VARIABLES if name not in self._group]
        for name in new:  # written before there was this variable
            _add_variable(self._group, name, self.study)
        if new:
            consolidate(path)
        self._arrays: dict[str, Any] = {name: self._group[name] for name in VARIABLES}

    @classmethod
    def create(cls, path: Path, study: Study, engine: str) -> ResultStore:
        """A new one, in which every cell is pending; `study` has documents, no names.

        Raises:
            InputError: If the place cannot be written.
        """
        partial = path.with_name(path.name + ".partial")
        try:
            shutil.rmtree(partial, ignore_errors=True)
            partial.parent.mkdir(parents=True, exist_ok=True)
            _lay_out(partial, study, engine)
            partial.rename(path)
        except OSError as error:
            raise InputError(f"cannot write {path}: {error.strerror or error}") from None
        return cls(path)

    @contextlib.contextmanager
    def writing(self) -> Iterator[None]:
        """Be the only writer meanwhile.

        Raises:
            InputError: If another process is.
        """
        with self.path.with_name(f".{self.path.name}.lock").open("w") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                raise InputError(f"another process is at the study in {self.path}") from None
            yield

    @property
    def states(self) -> Ints32:
        """State of every cell, in the axes' shape."""
        states: Ints32 = self._arrays["state"][...]
        return states

    def write(self, records: Mapping[int, Record]) -> None:
        """Write down cells that are pending, by their numbers."""
        if not records:
            return
        places = np.unravel_index(np.fromiter(records, np.int64), self.study.shape)
        for name in _STATE_LAST:
            values = [record[name] for record in records.values()]
            if not all(VARIABLES[name].is_missing(value) for value in values):  # it is so already
                self._put(name, places, values)

    def _put(self, name: str, places: Places, values: Sequence[Any]) -> None:
        dtype: Any = VARIABLES[name].dtype
        kind = np.dtypes.StringDType() if VARIABLES[name].kind == "word" else dtype
        self._arrays[name].vindex[places] = np.array(values, dtype=kind)

    def read(self, name: str, places: Places) -> NDArray[Any]:
        """One variable of some cells."""
        values: NDArray[Any] = self._arrays[name].vindex[places]
        return values

    def records(self, cells: Sequence[int]) -> dict[int, Record]:
        """What is known of some cells."""
        places = np.unravel_index(np.asarray(cells, np.int64), self.study.shape)
        columns = {name: self.read(name, places).tolist() for name in VARIABLES}
        return {
            cell: {name: column[k] for name, column in columns.items()}
            for k, cell in enumerate(cells)
        }

    def counts(self) -> dict[str, int]:
        """How many cells are in each state."""
        states = self.states
        return {
            name: int((states == value).sum())
            for name, value in
            (("pending", PENDING), ("done", DONE), ("refused", REFUSED), ("failed", FAILED))
        }  # fmt: skip

    def forget_failures(self) -> int:
        """Let failed cells be tried again; how many there were."""
        states = self.states
        failed = np.nonzero(states == FAILED)
        count = len(failed[0])
        if count:
            for name in reversed(_STATE_LAST):
                self._put(name, failed, [VARIABLES[name].missing] * count)
        return count

    def adopt(self, other: ResultStore) -> int:
        """Take over the cells that another study of the family shares; how many they are."""
        theirs = np.nonzero(other.states != PENDING)
        keep = np.ones(len(theirs[0]), bool)
        ours: list[NDArray[np.intp]] = []
        for axis, old, index in zip(self.study.axes, other.study.axes, theirs, strict=True):
            where = {value: k for k, value in enumerate(axis.points)}
            table = np.array([where.get(value, -1) for value in old.points], np.intp)
            ours.append(table[index])
            keep &= ours[-1] >= 0
        if not keep.any():
            return 0
        source = tuple(index[keep] for index in theirs)
        goal = tuple(index[keep] for index in ours)
        for name in _STATE_LAST:
            self._arrays[name].vindex[goal] = other.read(name, source)
        return int(keep.sum())


def _lay_out(path: Path, study: Study, engine: str) -> None:
    attributes: dict[str, Any] = {
        "schema": _SCHEMA,
        "id": study_id(study, engine),
        "engine": engine,
        "created": time.time(),
        "family": study.family,
        "title": study.name or "A study of Stairwright",
        "study": study.model_dump_json(),
    }
    group = zarr.open_group(path, mode="w", zarr_format=3, attributes=attributes)
    for axis in study.axes:
        values = np.array(axis.points, dtype="f8" if axis.numeric else np.dtypes.StringDType())
        made = group.create_array(
            axis.name,
            shape=values.shape,
            dtype="f8" if axis.numeric else str,
            chunks=values.shape,
            dimension_names=(axis.name,),
            attributes={"units": target(axis.name, study.method).unit} if axis.numeric else {},
        )
        made[...] = values
    for name in VARIABLES:
        _add_variable(group, name, study)
    consolidate(path)


def consolidate(path: Path) -> None:
    """Put the metadata of all arrays where readers find it at once; filling changes none of it."""
    with warnings.catch_warnings():
        # Zarr's version 3 does not specify it yet: readers that do not know it read each array's.
        warnings.simplefilter("ignore", ZarrUserWarning)
        zarr.consolidate_metadata(path)


def _add_variable(group: zarr.Group, name: str, study: Study) -> None:
    """An array over all axes that holds nothing yet."""
    variable = VARIABLES[name]
    about: dict[str, Any] = {"long_name": variable.text}
    if variable.kind == "number":
        about["units"] = variable.unit
    group.create_array(
        name,
        shape=study.shape,
        dtype=str if variable.kind == "word" else variable.dtype,
        chunks=_chunks(study.shape),
        dimension_names=tuple(axis.name for axis in study.axes),
        fill_value=variable.missing,
        attributes=about,
    )


def _chunks(shape: Sequence[int]) -> tuple[int, ...]:
    """Whole last axes, as many as make a chunk; of large studies few chunks all the same."""
    out, room = [1] * len(shape), max(_CHUNK, math.prod(shape) // _MOST_CHUNKS)
    for k in reversed(range(len(shape))):
        out[k] = max(1, min(shape[k], room))
        room //= out[k]
    return tuple(out)
