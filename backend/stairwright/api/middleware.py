"""Around every request: an id, a line in the log, a count; the size limit; compression."""

from __future__ import annotations

import logging
import re
import secrets
import time
from contextvars import ContextVar

from starlette.datastructures import Headers, MutableHeaders
from starlette.exceptions import HTTPException
from starlette.middleware.gzip import GZipMiddleware
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from .metrics import Metrics
from .problems import Problem
from .responses import WORTH_PACKING

logger = logging.getLogger("stairwright.access")
request_id: ContextVar[str] = ContextVar("request_id", default="")

_REQUEST_ID = re.compile(r"[\w.-]{1,64}", re.ASCII)
PREFIX = "/api/v1"
PLANS_PATH = f"{PREFIX}/plans"
IMPORT_PATHS = (
    f"{PREFIX}/terrains/import",
    f"{PREFIX}/terrains/import/heights",
    f"{PREFIX}/robots/import",
)


class Observe:
    """Gives each request an id (the client's own if it sent one), logs it and counts it."""

    def __init__(self, app: ASGIApp, metrics: Metrics) -> None:
        self.app = app
        self.metrics = metrics

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        given = Headers(scope=scope).get("x-request-id", "")
        name = given if _REQUEST_ID.fullmatch(given) else secrets.token_hex(8)
        token = request_id.set(name)
        start, status = time.perf_counter(), 500

        async def send_with_id(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
                MutableHeaders(scope=message)["x-request-id"] = name
            await send(message)

        try:
            await self.app(scope, receive, send_with_id)
        finally:
            seconds = time.perf_counter() - start
            route = _template(scope)
            record(self.metrics, scope, scope["method"], route, status, seconds)
            request_id.reset(token)


def record(
    metrics: Metrics, scope: Scope, method: str, route: str, status: int, seconds: float
) -> None:
    """Count one answer, and write its line in the log."""
    metrics.observe(method, route, status, seconds)
    told = {"ms": round(seconds * 1e3, 1), "client": owner_of(scope)}
    logger.info("%s %s %d", method, scope["path"], status, extra=told)


def _template(scope: Scope) -> str:
    """The route's template, such as /api/v1/terrains/{name}: as few labels as there are routes."""
    template: str = getattr(scope.get("route"), "path", "")
    if not template:
        return "other"
    inside = scope["path"].startswith(PREFIX) and not template.startswith(PREFIX)
    return PREFIX + template if inside else template


class LimitBody:
    """Answers 413 to bodies beyond the limit, announced or not, before anything is parsed."""

    def __init__(self, app: ASGIApp, limit: int, upload_limit: int) -> None:
        self.app = app
        self.limit = limit
        self.upload_limit = upload_limit

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        limit = self.upload_limit if scope["path"] in IMPORT_PATHS else self.limit
        announced = Headers(scope=scope).get("content-length", "0")
        if not announced.isascii() or not announced.isdigit() or int(announced[:20]) > limit:
            await _too_large(limit).response()(scope, receive, send)
            return
        received = 0

        async def receive_limited() -> Message:
            nonlocal received
            message = await receive()
            if message["type"] == "http.request":
                received += len(message.get("body", b""))
                if received > limit:
                    problem = _too_large(limit)
                    raise HTTPException(problem.status, problem.detail, problem.headers)
            return message

        await self.app(scope, receive_limited, send)


class Compress:
    """Gzips answers, except those of the routes that decide about it themselves."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app
        self.gzip = GZipMiddleware(app, minimum_size=WORTH_PACKING, compresslevel=4)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        itself = scope["type"] == "http" and scope["path"] == PLANS_PATH
        await (self.app if itself and scope["method"] == "POST" else self.gzip)(
            scope, receive, send
        )


def _too_large(limit: int) -> Problem:
    detail = f"the body has more than {limit} bytes"
    return Problem(413, detail, kind="too-large", headers={"connection": "close"})


def owner_of(scope: Scope) -> str:
    """Who asks, for the fair queue and the log: the client's address."""
    client = scope.get("client")
    return str(client[0]) if client else "local"
