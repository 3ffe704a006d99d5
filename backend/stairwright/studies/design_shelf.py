"""Results of design searches beside what they tried: they can be read while a search goes on."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import orjson

from stairwright.documents import Model

from .design_document import Aim
from .design_result import DesignResult

RESULT = "result.json"


class DesignSummary(Model):
    """What a list tells of a design search."""

    id: str
    name: str
    changed: float  # Unix time [s]
    designs: int  # to try
    tried: int
    passed: int
    best: int
    complete: bool
    aims: list[Aim]


def keep_result(result: DesignResult, folder: Path) -> None:
    """Write what was found so far into the search's own folder, all of it or nothing."""
    folder.mkdir(parents=True, exist_ok=True)
    aside = folder / f".{RESULT}.{os.getpid()}"
    aside.write_bytes(result.model_dump_json().encode())
    aside.replace(folder / RESULT)


def summary_of(result: Mapping[str, Any], changed: float) -> DesignSummary:
    """What a list tells of a result as JSON tells it.

    Raises:
        KeyError, TypeError, ValueError: If it is none.
    """
    design, candidates = result["design"], result["candidates"]
    return DesignSummary(
        id=result["id"],
        name=design["name"],
        changed=changed,
        designs=design["designs"],
        tried=len(candidates),
        passed=sum(each["passed"] for each in candidates),
        best=sum(each["best"] for each in candidates),
        complete=result["complete"],
        aims=design["aims"],
    )


def kept_results(studies: Path) -> list[DesignSummary]:
    """Of the folder that studies are kept in, newest first; what cannot be read is left out."""
    found = [_summary(path) for path in studies.glob(f"d-*/{RESULT}")]
    return sorted((each for each in found if each), key=lambda each: -each.changed)


def read_result(studies: Path, name: str) -> bytes | None:
    """The result as JSON; None if there is none by that id."""
    try:
        return (studies / name / RESULT).read_bytes()
    except OSError:
        return None


def _summary(path: Path) -> DesignSummary | None:
    try:
        return summary_of(orjson.loads(path.read_bytes()), path.stat().st_mtime)
    except (OSError, ValueError, KeyError, TypeError):
        return None  # half gone, or another program's
