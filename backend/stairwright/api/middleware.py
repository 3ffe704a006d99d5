"""Around every request: an id, a line in the log, a count; the size limit; the gate."""

from __future__ import annotations

import hashlib
import hmac
import logging
import re
import secrets
import time
from collections.abc import Collection
from contextvars import ContextVar
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qsl, urlencode, urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.exceptions import HTTPException
from starlette.middleware.gzip import GZipMiddleware
from starlette.responses import RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from .metrics import Metrics
from .problems import Problem
from .responses import WORTH_PACKING
from .settings import LOOPBACK

logger = logging.getLogger("stairwright.access")
request_id: ContextVar[str] = ContextVar("request_id", default="")

_REQUEST_ID = re.compile(r"[\w.-]{1,64}", re.ASCII)
_COOKIE = "stairwright_token"
_OPEN = frozenset({"/healthz", "/api/v1/healthz"})
_SAFE = frozenset({"GET", "HEAD", "OPTIONS"})
PREFIX = "/api/v1"
PLANS_PATH = f"{PREFIX}/plans"
IMPORT_PATH = f"{PREFIX}/terrains/import"


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
        limit = self.upload_limit if scope["path"] == IMPORT_PATH else self.limit
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


class Gate:
    """Lets in whoever knows the token (if there is one), and no other web page's requests."""

    def __init__(self, app: ASGIApp, token: str, origins: Collection[str]) -> None:
        self.app = app
        self.token = token
        self.origins = origins
        # The cookie does not hold the token itself.
        self.cookie = hashlib.sha256(f"stairwright {token}".encode()).hexdigest()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        refusal = self._refusal(scope)
        if refusal is None:
            await self.app(scope, receive, send)
        elif scope["type"] == "websocket":
            await send({"type": "websocket.close", "code": 1008, "reason": "not allowed"})
        else:
            await refusal(scope, receive, send)

    def _refusal(self, scope: Scope) -> Response | None:
        headers = Headers(scope=scope)
        unsafe = scope["type"] == "websocket" or scope["method"] not in _SAFE
        origin = headers.get("origin")
        if unsafe and origin and not same_site(origin, headers.get("host"), self.origins):
            return Problem(403, f"requests from {origin} are not allowed", kind="origin").response()
        if not self.token or scope["path"] in _OPEN or self._knows(headers):
            return None
        query = parse_qsl(scope["query_string"].decode("latin-1"), keep_blank_values=True)
        given = dict(query).get("token", "")
        if given and _same(given, self.token) and scope["type"] == "http":
            return self._welcome(scope, [pair for pair in query if pair[0] != "token"])
        challenge = {"www-authenticate": 'Bearer realm="stairwright"'}
        detail = "this needs the token: Authorization: Bearer …, or open /?token=…"
        return Problem(401, detail, kind="token", headers=challenge).response()

    def _knows(self, headers: Headers) -> bool:
        scheme, _, given = headers.get("authorization", "").partition(" ")
        if scheme.lower() == "bearer" and _same(given.strip(), self.token):
            return True
        try:
            morsel = SimpleCookie(headers.get("cookie", "")).get(_COOKIE)
        except CookieError:
            return False
        return morsel is not None and _same(morsel.value, self.cookie)

    def _welcome(self, scope: Scope, query: list[tuple[str, str]]) -> Response:
        """Keep the token in a cookie and take it out of the address."""
        path = "/" + scope["path"].lstrip("/")  # never another host
        target = path + (f"?{urlencode(query)}" if query else "")
        response = RedirectResponse(target, 303)
        secure = scope.get("scheme") == "https"
        response.set_cookie(_COOKIE, self.cookie, httponly=True, samesite="lax", secure=secure)
        return response


def same_site(origin: str, host: str | None, allowed: Collection[str]) -> bool:
    """Whether a page of `origin` may call a service that is addressed as `host`.

    Its own pages may, listed ones, and pages on this machine if the service is addressed so.
    """
    if origin in allowed or (host and origin in (f"http://{host}", f"https://{host}")):
        return True
    try:
        page, service = urlsplit(origin).hostname, urlsplit(f"//{host}").hostname
    except ValueError:
        return False
    return page in LOOPBACK and service in LOOPBACK


def _same(given: str, secret: str) -> bool:
    return hmac.compare_digest(given.encode("utf-8", "replace"), secret.encode())


def owner_of(scope: Scope) -> str:
    """Who asks, for the fair queue and the log: the client's address."""
    client = scope.get("client")
    return str(client[0]) if client else "local"
