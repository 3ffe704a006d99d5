"""What the arguments of commands name: plans, terrains, settings."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .errors import InputError
from .library import load_terrain
from .terrain.generation import GENERATORS, terrain_in

if TYPE_CHECKING:
    from .planning.plan import Method, Plan
    from .terrain.profile import Terrain

Arguments = argparse.Namespace
_OF_PLANS = ("robot", "method", "solver", "weight", "timing", "facing", "tolerance")


def terrain_of(source: str) -> Terrain:
    """What `load_terrain` finds; or of a kind: ``stair:rise=0.18,run=0.28,count=5``."""
    kind, colon, measures = source.partition(":")
    if not (colon and kind in GENERATORS):
        return load_terrain(source)
    given = settings_of(filter(None, measures.split(",")), kind)
    whole = {name: int(v) for name, v in given.items() if isinstance(v, float) and v.is_integer()}
    return terrain_in({"kind": kind, **given, **whole})


def planned(source: str, given: Arguments) -> Plan:
    """A plan over the terrain `source`."""
    from .planning.planner import plan

    method: Method = given.method or "path"
    return plan(
        terrain_of(source),
        given.robot or "a1_wheeled",
        friction=given.friction,
        method=method,
        weights=settings_of(given.weight, "weights"),
        solver=given.solver,
        timing=given.timing or "steady",
        facing=given.facing,
        tolerance=settings_of(given.tolerance, "tolerance"),
    )


def plan_or_file(given: Arguments) -> Plan:
    """The plan in a file if it is one, else a plan over the terrain."""
    path = Path(given.source)
    if path.suffix.lower() in (".json", ".npz") and path.exists():
        from .export.formats import load
        from .planning.plan import Plan

        if path.suffix.lower() == ".npz" or _schema(path) != "terrain":
            document = load(path)
            if isinstance(document, Plan):
                for name in _OF_PLANS:
                    if getattr(given, name):
                        raise InputError("the plan says it already", (name,))
                return document
            if document.plan is not None:
                return document.plan
            raise InputError(f"{path} is a rollout without its plan")
    return planned(given.source, given)


def _schema(path: Path) -> str:
    from .documents import load_mapping

    data = load_mapping(path)
    schema = str(data.get("schema", ""))
    bare = not schema and ("points" in data or "kind" in data)
    return "terrain" if bare or schema == "stairwright/terrain/1" else schema


def settings_of(pairs: Iterable[str], field: str) -> dict[str, Any]:
    """``name=value`` pairs; values are numbers, truth values or words."""
    settings: dict[str, Any] = {}
    for pair in pairs:
        name, equals, text = pair.partition("=")
        if not equals or not name:
            raise InputError(f"expected NAME=VALUE, got {pair!r}", (field,))
        words = {"true": True, "false": False}
        try:
            settings[name] = words[text] if text in words else float(text)
        except ValueError:
            settings[name] = text
    return settings
