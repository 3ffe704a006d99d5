"""Optuna proposes robots, an engine tries them; what was found is kept as it comes."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import optuna

from stairwright.errors import InputError
from stairwright.robot.description import Robot

from .dataset import dataset_of
from .design_document import MASS, Aim, Design, design_id
from .design_result import Candidate, DesignResult, with_best
from .design_shelf import keep_result
from .document import Study, study_id
from .fill import fill, is_complete
from .keeping import kept_store
from .progress import Pace, Progress, Report
from .question import varied_robot
from .serial import Engine, Stopped
from .store import ResultStore
from .targets import target
from .version import engine_of

_START = 16  # designs that are spread over the bounds before any is foretold
_TOLD = 2.0  # s between results that are kept for whoever looks on


def search(
    design: Design,
    engine: Engine,
    folder: Path,
    report: Report,
    stopped: Stopped = lambda: False,
) -> DesignResult:
    """Carry a search out, or go on with the one in `folder`, where its result is kept, too.

    Raises:
        InputError: If `folder` holds something else.
    """
    version = engine_of(design.ask)
    name = design_id(design, version)
    told, kept = -math.inf, 0
    trying = _Search(design, engine, folder, version, stopped)

    def result(complete: bool) -> DesignResult:
        candidates = with_best(design.aims, trying.tried)
        return DesignResult(id=name, design=design, complete=complete, candidates=candidates)

    def tell(progress: Progress) -> None:
        nonlocal told, kept
        if progress.done > kept and time.monotonic() - told >= _TOLD:
            keep_result(result(False), folder)
            told, kept = time.monotonic(), progress.done
        report(progress)

    found = result(trying.run(tell))
    keep_result(found, folder)
    return found


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
        self._pace: Pace | None = None  # since there is work: what is replayed takes none
        self._design, self._engine, self._folder = design, engine, folder
        self._version, self._stopped = version, stopped
        optuna.logging.set_verbosity(optuna.logging.ERROR)
        sampler = optuna.samplers.TPESampler(
            seed=design.seed, n_startup_trials=_START, constant_liar=True
        )
        self._optuna = optuna.create_study(
            sampler=sampler, directions=[aim.direction for aim in design.aims]
        )

    def run(self, report: Report) -> bool:
        """Try generations until there are enough; False if it was stopped before."""
        design, number = self._design, 0
        while len(self.tried) < design.designs:
            count = min(design.generation, design.designs - len(self.tried))
            proposed = [self._propose() for _ in range(count)]
            path = self._folder / f"{number:05d}.zarr"
            candidates = self._tried(proposed, path, report)
            if candidates is None:
                return False
            for proposal, candidate in zip(proposed, candidates, strict=True):
                self._tell(proposal, candidate)
            number += 1
            report(self._progress())
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

    def _tried(
        self, proposed: list[_Proposal], path: Path, report: Report
    ) -> list[Candidate] | None:
        """What came of a generation; None if it was stopped."""

        def working(progress: Progress) -> None:
            report(self._progress(len(proposed) * progress.done / max(1, progress.total)))

        robots = {f"d{k}": each.robot for k, each in enumerate(proposed) if each.robot is not None}
        dataset: Any = None
        if robots:
            store = self._store(self._design.asking(robots), path)
            if not is_complete(store):
                self._pace = self._pace or Pace(len(self.tried))
                with store.writing():
                    fill(store, self._engine, working, self._stopped)
                if not is_complete(store):
                    return None
            dataset = dataset_of(store)
        return [
            self._candidate(each, None if each.robot is None else dataset.sel(robot=f"d{k}"))
            for k, each in enumerate(proposed)
        ]

    def _progress(self, partly: float = 0.0) -> Progress:
        """With so much of the generation at work."""
        done, total = len(self.tried), self._design.designs
        left = None if self._pace is None else self._pace.left(done + partly, total)
        return Progress(done, total, left, partly)

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
