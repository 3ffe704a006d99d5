"""Design studies: Optuna proposes robots, the engine of studies tries them.

Designs come in generations of a fixed size, each one study over its robots: the same document gives
the same designs whoever computes them, and one that was interrupted is replayed from its stores.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import optuna

from stairwright.documents import load_mapping, parse
from stairwright.errors import InputError
from stairwright.library import load_robot, load_terrain
from stairwright.robot.description import Robot

from .dataset import dataset_of
from .design_document import MASS, Aim, Design, design_id
from .design_result import Candidate, DesignResult, with_best
from .design_shelf import keep_result
from .document import Study, study_id
from .fill import fill, is_complete
from .keeping import kept_store, studies_folder
from .question import Questions, varied_robot
from .resolve import resolve
from .serial import Engine, Stopped
from .store import ResultStore
from .study import BUDGET, choose_engine
from .targets import target
from .version import engine_of

_START = 16  # designs that are spread over the bounds before any is foretold
_TOLD = 2.0  # s between results that are kept for whoever looks on


def design(
    document: str | Path | Mapping[str, Any] | Design,
    scheduler: str | None = None,
    workers: int | None = None,
    *,
    store: str | Path | None = None,
    budget: int = BUDGET,
    progress: Callable[[int, int], None] | None = None,
    stopped: Stopped = lambda: False,
) -> DesignResult:
    """Look for the best dimensions of a robot within bounds.

    Args:
        document: A file, a mapping or a `Design`.
        scheduler: Address of a Dask scheduler, see `study`.
        workers: How many processes, see `study`.
        store: Folder of what was tried; in the data folder by default.
        budget: Plans, rollouts or trials that it may take.
        progress: Called with the designs that were tried and that are to be.
        stopped: Asked now and then; what was tried until then is kept.

    Raises:
        InputError: If the document or an argument is bad.
    """
    chosen = prepared_design(document, budget)
    version = engine_of(chosen.ask)
    name = design_id(chosen, version)
    folder = studies_folder() / name if store is None else Path(store)
    engine = choose_engine(scheduler, workers)
    search = _Search(chosen, engine, folder, version, stopped)
    told = -math.inf

    def result(complete: bool) -> DesignResult:
        candidates = with_best(chosen.aims, search.tried)
        return DesignResult(id=name, design=chosen, complete=complete, candidates=candidates)

    def tell(done: int, total: int) -> None:
        nonlocal told
        if time.monotonic() - told >= _TOLD:
            keep_result(result(False), folder)
            told = time.monotonic()
        if progress is not None:
            progress(done, total)

    try:
        complete = search.run(tell)
    finally:
        engine.close()
    found = result(complete)
    keep_result(found, folder)
    return found


def prepared_design(
    document: str | Path | Mapping[str, Any] | Design, budget: int = BUDGET
) -> Design:
    """The design with names resolved, refused if it is too much or makes no question.

    Raises:
        InputError: With the field that is wrong.
    """
    if isinstance(document, Design):
        chosen = document
    else:
        data = document if isinstance(document, Mapping) else load_mapping(Path(document))
        chosen = parse(Design, dict(data))
    if chosen.effort > budget:
        raise InputError(
            f"{chosen.effort:,} cells are more than the budget of {budget:,}; try fewer designs, "
            "or raise the budget",
            ("designs",),
        )
    try:
        ask = resolve(chosen.ask, load_terrain, load_robot, chosen.names)
    except InputError as error:
        raise error.within("ask") from None
    robot = ask.robot
    assert isinstance(robot, Robot)
    chosen = chosen.model_copy(update={"ask": ask})
    try:
        questions = Questions(chosen.asking({"d": robot}))
        questions.at([axis.points[0] for axis in questions.study.axes])
    except InputError as error:
        raise error.within("ask") from None
    for i, each in enumerate(chosen.vary):
        failures = []
        for end in each.between:
            try:
                varied_robot(robot, [(target(each.name), end)])
            except InputError as error:
                failures.append(error)
        if len(failures) == 2:
            why = f"neither end makes a robot: {failures[0]}"
            raise InputError(why, ("vary", i, "between"))
    return chosen


@dataclass
class _Proposal:
    trial: optuna.trial.Trial
    values: dict[str, float]
    robot: Robot | None  # None where the values make none
    reason: str = ""


class _Search:
    def __init__(
        self, design: Design, engine: Engine, folder: Path, version: str, stopped: Stopped
    ) -> None:
        self.tried: list[Candidate] = []
        self._design, self._engine, self._folder = design, engine, folder
        self._version, self._stopped = version, stopped
        optuna.logging.set_verbosity(optuna.logging.ERROR)
        sampler = optuna.samplers.TPESampler(
            seed=design.seed, n_startup_trials=_START, constant_liar=True
        )
        self._optuna = optuna.create_study(
            sampler=sampler, directions=[aim.direction for aim in design.aims]
        )

    def run(self, progress: Callable[[int, int], None]) -> bool:
        """Try generations until there are enough; False if it was stopped before."""
        design, number = self._design, 0
        while len(self.tried) < design.designs:
            count = min(design.generation, design.designs - len(self.tried))
            proposed = [self._propose() for _ in range(count)]
            candidates = self._tried(proposed, self._folder / f"{number:05d}.zarr")
            if candidates is None:
                return False
            for proposal, candidate in zip(proposed, candidates, strict=True):
                self._tell(proposal, candidate)
            number += 1
            progress(len(self.tried), design.designs)
        return True

    def _propose(self) -> _Proposal:
        trial = self._optuna.ask()
        values = {
            each.name: trial.suggest_float(each.name, *each.between, log=each.log)
            for each in self._design.vary
        }
        robot = self._design.ask.robot
        assert isinstance(robot, Robot)
        try:
            made = varied_robot(robot, [(target(name), value) for name, value in values.items()])
        except InputError as error:
            return _Proposal(trial, values, None, str(error))
        return _Proposal(trial, values, made)

    def _tried(self, proposed: list[_Proposal], path: Path) -> list[Candidate] | None:
        """What came of a generation; None if it was stopped."""
        robots = {f"d{k}": each.robot for k, each in enumerate(proposed) if each.robot is not None}
        dataset: Any = None
        if robots:
            store = self._store(self._design.asking(robots), path)
            if not is_complete(store):
                with store.writing():
                    fill(store, self._engine, None, self._stopped)
                if not is_complete(store):
                    return None
            dataset = dataset_of(store)
        return [
            self._candidate(each, None if each.robot is None else dataset.sel(robot=f"d{k}"))
            for k, each in enumerate(proposed)
        ]

    def _store(self, study: Study, path: Path) -> ResultStore:
        return kept_store(study, study_id(study, self._version), self._version, path)

    def _candidate(self, proposal: _Proposal, cells: Any) -> Candidate:
        """A design with the worst of its cells."""
        aims: dict[str, float | None] = {aim.name: None for aim in self._design.aims}
        if proposal.robot is None:
            return Candidate(
                values=proposal.values, aims=aims, passed=False, reason=proposal.reason
            )
        within = cells["feasible"].values & (cells["success"].values == cells["trials"].values)
        if np.all(within):
            aims = {aim.name: _reached(aim, proposal, cells) for aim in self._design.aims}
            if None not in aims.values():
                return Candidate(
                    values=proposal.values, aims=aims, passed=True, robot=proposal.robot
                )
            aims = dict.fromkeys(aims)
        words = [str(text) for name in ("message", "outcome") for text in np.ravel(cells[name])]
        reason = next((text for text in words if text), "it has no outcome")
        return Candidate(values=proposal.values, aims=aims, passed=False, reason=reason)

    def _tell(self, proposal: _Proposal, candidate: Candidate) -> None:
        self.tried.append(candidate)
        aims = self._design.aims
        if candidate.passed:
            self._optuna.tell(proposal.trial, [candidate.aims[aim.name] or 0.0 for aim in aims])
        else:
            self._optuna.tell(proposal.trial, [self._worst(aim) for aim in aims])

    def _worst(self, aim: Aim) -> float:
        """For designs that do not pass: no better than any that does."""
        bounds = {each.name: each.between for each in self._design.vary}
        low, high = aim.between or bounds.get(aim.name) or self._seen(aim)
        return high if aim.direction == "minimize" else low

    def _seen(self, aim: Aim) -> tuple[float, float]:
        values = [each.aims[aim.name] or 0.0 for each in self.tried if each.passed]
        return (min(values), max(values)) if values else (0.0, 0.0)


def _reached(aim: Aim, proposal: _Proposal, cells: Any) -> float | None:
    """What a design that passes reaches; the worst of its cells."""
    assert proposal.robot is not None
    if aim.between is None and aim.name in proposal.values:
        return proposal.values[aim.name]
    if aim.name == MASS:
        return proposal.robot.mass
    values = np.ravel(cells["boundary" if aim.between is not None else aim.name].values)
    worst = float(values.min() if aim.direction == "maximize" else values.max())
    return None if math.isnan(worst) else worst
