"""The OpenAPI document: FastAPI's, with problem documents instead of its own error format."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi

from .described import complete
from .problems import FieldError, ProblemDocument


def install(app: FastAPI, *, token: bool) -> None:
    """Let `app` describe itself so."""

    @lru_cache(maxsize=1)
    def document() -> dict[str, Any]:
        made = get_openapi(
            title=app.title, version=app.version, description=app.description, routes=app.routes
        )
        schemas = made.setdefault("components", {}).setdefault("schemas", {})
        template = "#/components/schemas/{model}"
        schemas["FieldError"] = FieldError.model_json_schema(ref_template=template)
        problem = ProblemDocument.model_json_schema(ref_template=template)
        problem.pop("$defs", None)
        schemas["ProblemDocument"] = problem
        for unused in ("HTTPValidationError", "ValidationError"):
            schemas.pop(unused, None)
        made["components"]["schemas"] = _even_tuples(schemas)
        complete(made)
        if token:
            made["components"]["securitySchemes"] = {"token": {"type": "http", "scheme": "bearer"}}
            made["security"] = [{"token": []}]
        return made

    app.openapi = document  # type: ignore[method-assign]


def _even_tuples(node: Any) -> Any:
    """Tuples of one kind of item as arrays of a fixed length, which more tools understand."""
    if isinstance(node, list):
        return [_even_tuples(each) for each in node]
    if not isinstance(node, dict):
        return node
    plain = {key: _even_tuples(value) for key, value in node.items()}
    items = plain.get("prefixItems")
    if isinstance(items, list) and items and all(each == items[0] for each in items):
        del plain["prefixItems"]
        plain["items"] = items[0]
    return plain
