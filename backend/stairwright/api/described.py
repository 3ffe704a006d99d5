"""What generators of clients need beyond FastAPI's OpenAPI document.

Names that are fit to call, headers of answers, kinds of problems, files as bytes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from http import HTTPStatus
from typing import Any

from fastapi.routing import APIRoute

# Routes are called after their methods; clients after what they do.
_OPERATIONS = {
    "design_events": "follow_design",
    "generate": "generate_terrain",
    "get_study_document": "get_question",
    "healthz": "get_health",
    "job_events": "follow_job",
    "post_design": "create_design",
    "post_margins": "create_margins",
    "post_plan": "create_plan",
    "post_rollout": "create_rollout",
    "post_session": "create_session",
    "post_study": "create_study",
    "post_trials": "create_trials",
    "put_playback": "set_playback",
    "put_robot": "save_robot",
    "put_scene": "set_scene",
    "put_terrain": "save_terrain",
    "settings": "get_settings",
    "study_events": "follow_study",
}

TAGS = {
    "service": "Whether the service is ready.",
    "settings": "Weights of the planners and settings of the controller.",
    "robots": "Presets and saved robots; import of URDF and MJCF.",
    "terrains": "Presets and saved terrains; import and generation.",
    "plans": "How a robot gets over a terrain.",
    "rollouts": "Plans carried out in simulation.",
    "trials": "A plan carried out many times under random deviations.",
    "margins": "How much delay a plan stands, and how much less friction.",
    "studies": "One question over whole ranges of terrains, frictions and robots.",
    "jobs": "Work that takes longer than a request.",
    "sessions": "3D scenes of the page.",
}

# The last part of a problem's `type`, by status: urn:stairwright:problem:KIND.
KINDS: Mapping[int, tuple[str, ...]] = {
    400: ("bad-json", "host"),
    401: ("token",),
    403: ("origin", "read-only"),
    404: ("not-found",),
    408: ("overdue",),
    409: ("cancelled", "full", "idempotency", "not-ours"),
    413: ("too-large",),
    415: ("media-type",),
    421: ("host",),
    422: ("bad-input", "idempotency"),
    429: ("attempts", "connections", "queue-full", "sessions"),
    431: ("too-large",),
    500: ("bug",),
    501: ("missing",),
    503: (
        "deadline", "failed", "interrupted", "memory", "missing", "no-scene", "other-version",
        "starting", "unavailable", "unreachable", "worker-died",
    ),
}  # fmt: skip
URN = "urn:stairwright:problem:"

_TEXT, _COUNT = {"type": "string"}, {"type": "integer", "minimum": 0}
_HEADERS: dict[str, dict[str, Any]] = {
    "ETag": {"description": "this version, for If-None-Match", "schema": _TEXT},
    "Location": {"description": "where what was made is", "schema": _TEXT},
    "Content-Location": {"description": "where the plan is kept", "schema": _TEXT},
    "Content-Disposition": {"description": "attachment and a file name", "schema": _TEXT},
    "Link": {"description": 'the next page, rel="next"; absent on the last', "schema": _TEXT},
    "X-Total-Count": {"description": "how many there are on all pages", "schema": _COUNT},
    "Retry-After": {"description": "ask again after so many seconds", "schema": _COUNT},
    "WWW-Authenticate": {"description": "Bearer", "schema": _TEXT},
}
_MADE = {  # by operation and status
    ("create_design", "202"): ("Location", "Retry-After"),
    ("create_margins", "202"): ("Location", "Retry-After"),
    ("create_plan", "200"): ("ETag", "Content-Location"),
    ("create_rollout", "202"): ("Location", "Retry-After"),
    ("create_session", "201"): (),
    ("save_robot", "200"): ("ETag",),
    ("save_robot", "201"): ("ETag", "Location"),
    ("create_study", "202"): ("Location", "Retry-After"),
    ("create_trials", "202"): ("Location", "Retry-After"),
    ("save_terrain", "200"): ("ETag",),
    ("save_terrain", "201"): ("ETag", "Location"),
}
_REFUSED = {"401": "WWW-Authenticate", "429": "Retry-After", "503": "Retry-After"}
_WITHOUT_TAG = {
    "follow_design", "follow_job", "follow_study", "get_cell", "get_cells", "get_health", "get_job",
    "get_question", "get_settings", "get_study",
}  # fmt: skip
ANY_FILE = "application/octet-stream"


def operation_id(route: APIRoute) -> str:
    """What generated clients call a route."""
    return _OPERATIONS.get(route.name, route.name)


def complete(document: dict[str, Any]) -> None:
    """Add all of it to an OpenAPI document."""
    document["info"] |= {"contact": {"name": "Stairwright"}, "license": {"name": "MIT"}}
    document["servers"] = [{"url": "/", "description": "the service that this comes from"}]
    used = {tag for _, each in _operations(document) for tag in each.get("tags", ())}
    document["tags"] = [
        {"name": name, "description": TAGS.get(name, name)}
        for name in [*TAGS, *sorted(used - set(TAGS))]
        if name in used
    ]
    document["components"]["headers"] = _HEADERS
    for method, operation in _operations(document):
        for status, response in operation["responses"].items():
            if int(status) >= 400:
                _list_kinds(int(status), response)
            elif any(
                media.get("schema", {}).get("format") == "binary" for media in _media(response)
            ):
                # Generators for one language or another know no other type of bytes.
                response["content"] = {ANY_FILE: _file()} | response["content"]
                response["description"] = (
                    "The file; its Content-Type is one of those listed, and it is bytes in any case"
                )
            names = _header_names(method, operation, status, response)
            if names:
                references = {name: {"$ref": f"#/components/headers/{name}"} for name in names}
                response["headers"] = references | response.get("headers", {})
    for schema in document["components"]["schemas"].values():
        for field in schema.get("properties", {}).values():
            if field.get("contentMediaType") == ANY_FILE:
                field["format"] = "binary"  # OpenAPI 3.0's word, the one that generators know
    kinds = sorted({kind for each in KINDS.values() for kind in each})
    document["components"]["schemas"]["ProblemDocument"]["properties"]["type"] |= {
        "description": "names the kind of problem; about:blank means no more than its status",
        "x-extensible-enum": ["about:blank", *(URN + kind for kind in kinds)],
    }


def _operations(document: Mapping[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    for operations in document["paths"].values():
        yield from operations.items()


def _media(response: Mapping[str, Any]) -> list[dict[str, Any]]:
    return list(response.get("content", {}).values())


def _file() -> dict[str, Any]:
    return {"schema": {"type": "string", "format": "binary"}}


def _list_kinds(status: int, response: dict[str, Any]) -> None:
    kinds = ", ".join(f"`{kind}`" for kind in KINDS.get(status, ()))
    if kinds:
        response["description"] = f"{HTTPStatus(status).phrase}: {kinds}"


def _header_names(
    method: str, operation: Mapping[str, Any], status: str, response: Mapping[str, Any]
) -> tuple[str, ...]:
    called = operation["operationId"]
    if (called, status) in _MADE:
        return _MADE[called, status]
    if int(status) >= 400:
        return (_REFUSED[status],) if status in _REFUSED else ()
    if method != "get" or status != "200" or called in _WITHOUT_TAG:
        return ()
    if ANY_FILE in response["content"]:
        return "ETag", "Content-Disposition"
    schema = response["content"].get("application/json", {}).get("schema", {})
    return ("ETag", "X-Total-Count", "Link") if schema.get("type") == "array" else ("ETag",)
