"""JSON: the document itself, as REST answers it."""

from __future__ import annotations

import orjson

from stairwright.planning.plan import Plan
from stairwright.simulation.result import Rollout


def document_json(document: Plan | Rollout) -> bytes:
    """The whole document; arrays as nested lists."""
    return orjson.dumps(document.model_dump(mode="json")) + b"\n"
