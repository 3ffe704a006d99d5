"""JSON: the document itself, as REST answers it."""

from __future__ import annotations

import orjson

from stairwright.documents import Model


def document_json(document: Model) -> bytes:
    """The whole document; arrays as nested lists."""
    return orjson.dumps(document.model_dump(mode="json")) + b"\n"
