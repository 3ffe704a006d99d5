"""Every error as ``application/problem+json`` (RFC 9457), with a field path for each bad value."""

from __future__ import annotations

import errno
import json
import logging
import math
import re
from collections.abc import Mapping, Sequence
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.routing import APIRoute
from pydantic import BaseModel, Field
from sqlalchemy.exc import DatabaseError, OperationalError
from starlette.exceptions import HTTPException
from starlette.responses import Response

from stairwright.complaints import SEVERAL, foremost, wording
from stairwright.errors import InputError
from stairwright.jobs.failures import Failure, problem
from stairwright.storage.opening import is_damage

MEDIA_TYPE = "application/problem+json"
MAX_ERRORS = 20
_LONGEST = 500  # characters of a message or path that may repeat what the client sent

_EXHAUSTED = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EMFILE, errno.EROFS)

logger = logging.getLogger(__name__)


class FieldError(BaseModel):
    """One bad value."""

    field: str = Field(description="path to the value, e.g. terrain.points.3", max_length=1000)
    message: str = Field(description="what is wrong with it", max_length=1000)


class ProblemDocument(BaseModel):
    """RFC 9457: what went wrong."""

    type: str = Field(description="names the kind of problem", examples=["about:blank"])
    title: str = Field(examples=["Unprocessable Content"])
    status: int = Field(examples=[422], ge=400, le=599)
    detail: str = Field(examples=["terrain.points.3: x must never decrease"])
    errors: list[FieldError] = []


class Problem(Exception):
    """Raised anywhere in the service to answer with a problem document."""

    def __init__(
        self,
        status: int,
        detail: str,
        *,
        kind: str = "",
        errors: Sequence[FieldError] = (),
        headers: Mapping[str, str] | None = None,
    ) -> None:
        super().__init__(detail)
        self.status = status
        self.detail = detail
        self.kind = kind
        self.errors = list(errors)
        self.headers = dict(headers or {})

    @property
    def document(self) -> dict[str, Any]:
        """The problem as plain data."""
        errors = [error.model_dump() for error in self.errors]
        return problem(self.status, self.kind, printable(self.detail), errors)

    def response(self) -> Response:
        """The answer to send."""
        body = json.dumps(self.document).encode()
        return Response(body, self.status, self.headers, media_type=MEDIA_TYPE)


def not_found(kind: str, name: str, field: str = "", by: str = "id") -> Problem:
    """404 for a thing of some kind; `field` if a value in the body named it."""
    there_is = "there are" if kind in SEVERAL else "there is"
    message = f"{there_is} no {kind} with the {by} {printable(name)!r}"
    errors = [FieldError(field=field, message=message)] if field else []
    return Problem(404, message, kind="not-found", errors=errors)


def from_input_error(error: InputError, *prefix: str) -> Problem:
    """422 for a value that our own checks refuse."""
    shown = error.within(*prefix) if prefix else error
    field = FieldError(field=_path(shown.field), message=printable(shown.message))
    return Problem(422, printable(str(shown)), kind="bad-input", errors=[field])


def printable(text: str) -> str:
    """`text` without lone surrogates and control characters, and not endless."""
    clean = re.sub(r"[\x00-\x1f\x7f\ud800-\udfff]", "\N{REPLACEMENT CHARACTER}", text)
    return clean if len(clean) <= _LONGEST else clean[: _LONGEST - 1] + "…"


def _path(loc: Sequence[str | int]) -> str:
    """A dotted path; the tags of unions, which start with ``~``, are no part of it."""
    return printable(".".join(str(part) for part in loc if not str(part).startswith("~")))


def _field_error(error: Mapping[str, Any], bodies: Sequence[Any]) -> FieldError:
    loc = list(error["loc"])
    source = loc.pop(0) if loc and loc[0] in ("body", "query", "path", "header") else ""
    message, cause = wording(error, *bodies), error.get("ctx", {}).get("error")
    if isinstance(cause, InputError):
        loc, message = [*loc, *cause.field], cause.message
    elif isinstance(cause, ValueError):
        message = str(cause)
    if source == "body" and not loc and error["type"] == "missing":
        message = "the body is empty"
    path = _path(loc) or ("" if source == "body" else str(source))
    return FieldError(field=path, message=printable(message))


def from_validation(errors: Sequence[Mapping[str, Any]], *bodies: Any) -> Problem:
    """400 if the body is no JSON at all, else 422, from pydantic's list of errors.

    `bodies` are the types of what was sent, to tell which fields there are.
    """
    errors = foremost(errors)
    first = errors[0]
    if first["type"] == "json_invalid":
        why = first.get("ctx", {}).get("error", "")
        return Problem(400, f"the body is not valid JSON: {printable(str(why))}", kind="bad-json")
    shown = [_field_error(error, bodies) for error in errors[:MAX_ERRORS]]
    head = f"{shown[0].field}: {shown[0].message}" if shown[0].field else shown[0].message
    more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
    return Problem(422, head + more, kind="bad-input", errors=shown)


def problem_of(error: Exception) -> Problem:
    """What went wrong, as the client is told; what only the log may know is written there."""
    if isinstance(error, Problem):
        return error
    if isinstance(error, InputError):
        return from_input_error(error)
    if isinstance(error, Failure):
        headers = {"retry-after": str(math.ceil(error.retry_after or 1.0))}
        return Problem(error.status, error.message, kind=error.kind, headers=headers)
    if isinstance(error, DatabaseError) and is_damage(error):
        logger.error("the database is damaged: %s", error.orig)
        return _unavailable("the database is damaged: restart the service, which sets it aside")
    if isinstance(error, OperationalError):
        logger.error("the database cannot be used now: %s", error.orig)
        return _unavailable("the database is busy or cannot be written")
    if isinstance(error, OSError) and error.errno in _EXHAUSTED:
        logger.error("the system refused: %s", error)
        return _unavailable(f"the server has a problem: {error.strerror}")
    logger.error("unexpected error", exc_info=error)
    return Problem(500, "this is a bug in the service; its log says more")


def install(app: FastAPI) -> None:
    """Let every exception leave as a problem document."""

    async def on_error(request: Request, error: Exception) -> Response:
        if isinstance(error, RequestValidationError):
            return from_validation(error.errors(), *_bodies(request)).response()
        return problem_of(error).response()

    # Named, since Starlette raises again what only the handler of Exception has answered.
    for kind in (Problem, RequestValidationError, InputError, Failure, DatabaseError, OSError):
        app.add_exception_handler(kind, on_error)
    app.add_exception_handler(Exception, on_error)

    @app.exception_handler(HTTPException)
    async def on_http(request: Request, error: HTTPException) -> Response:
        detail = str(error.detail)
        if error.status_code == 404 and detail == "Not Found":
            detail = f"there is nothing at {request.url.path}"
        headers = dict(error.headers or {})
        if error.status_code == 405:
            detail = f"{request.method} is not allowed here"
            allowed = _allowed_methods(app, request.url.path)
            headers = {"Allow": allowed} if allowed else headers
        return Problem(error.status_code, detail, headers=headers).response()


def _bodies(request: Request) -> list[Any]:
    """Types of what the request's route takes as its body."""
    route = request.scope.get("route")
    parameters = route.dependant.body_params if isinstance(route, APIRoute) else []
    return [parameter.field_info.annotation for parameter in parameters]


def _allowed_methods(app: FastAPI, path: str) -> str:
    """What may be done at `path`, for the Allow header; empty if nothing is known of it."""
    for template, operations in app.openapi()["paths"].items():
        pattern = re.sub(r"\\{\w+\\}", "[^/]+", re.escape(template))
        if re.fullmatch(pattern, path):
            methods = {method.upper() for method in operations}
            return ", ".join(sorted(methods | ({"HEAD"} if "GET" in methods else set())))
    return ""


def _unavailable(detail: str) -> Problem:
    return Problem(503, detail, kind="unavailable", headers={"retry-after": "2"})


def describe(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """OpenAPI's `responses` for the problems that a route can answer with."""
    schema = {"$ref": "#/components/schemas/ProblemDocument"}
    return {
        status: {
            "description": HTTPStatus(status).phrase,
            "content": {MEDIA_TYPE: {"schema": schema}},
        }
        for status in statuses
    }
