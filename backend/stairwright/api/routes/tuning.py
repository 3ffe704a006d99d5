"""What can be chosen: weights, controller settings, disturbances, and the formats of files."""

from __future__ import annotations

from functools import cache
from typing import Any

from fastapi import APIRouter

from stairwright.api.bodies import ExportFormat, SettingsDocument
from stairwright.control.settings import ControllerSettings
from stairwright.documents import Model
from stairwright.export.table import FORMATS
from stairwright.planning.tolerance import Tolerance
from stairwright.planning.weights import MODELS
from stairwright.simulation.disturbance import Disturbance
from stairwright.simulation.ranges import BUNDLES

router = APIRouter(tags=["settings"])


@router.get("/settings")
async def settings() -> SettingsDocument:
    """JSON Schemas; each property has title, description, default, bounds, unit and scale.

    `exports` are the formats that plans, rollouts and robots can be taken along in.
    """
    return _document()


@cache
def _document() -> SettingsDocument:
    weights = {method: _flat(model) for method, model in MODELS.items()}
    exports = {
        kind: [ExportFormat(name=name, note=each.note) for name, each in formats.items()]
        for kind, formats in FORMATS.items()
    }
    return SettingsDocument(
        weights=weights,
        tolerance=_flat(Tolerance),
        controller=_flat(ControllerSettings),
        disturbance=_flat(Disturbance),
        bundles=BUNDLES,
        exports=exports,
    )


def _flat(model: type[Model]) -> dict[str, Any]:
    """The model's schema with references to shared parts put in place."""
    schema = model.model_json_schema(by_alias=True)
    shared = schema.pop("$defs", {})

    def resolve(node: Any) -> Any:
        if isinstance(node, list):
            return [resolve(each) for each in node]
        if not isinstance(node, dict):
            return node
        kept = {key: resolve(value) for key, value in node.items() if key != "$ref"}
        if "$ref" not in node:
            return kept
        return {**resolve(shared[node["$ref"].rsplit("/", 1)[-1]]), **kept}

    schema["properties"] = {k: resolve(v) for k, v in schema.get("properties", {}).items()}
    return schema
