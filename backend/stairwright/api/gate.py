"""The gate: who knows the token may come in, and no other web page acts for a user."""

from __future__ import annotations

import hashlib
import hmac
import math
from collections.abc import Collection, Sequence
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qsl, urlencode

from starlette.datastructures import Headers
from starlette.responses import RedirectResponse, Response
from starlette.types import ASGIApp, Receive, Scope, Send

from .attempts import Attempts
from .middleware import owner_of
from .origins import same_site
from .problems import Problem

_COOKIE = "stairwright_token"
_OPEN = frozenset({"/healthz", "/api/v1/healthz"})
_SAFE = frozenset({"GET", "HEAD", "OPTIONS"})


class Gate:
    """Lets in whoever knows the token (if there is one), and no other web page's requests."""

    def __init__(
        self, app: ASGIApp, token: str, origins: Collection[str], attempts: Attempts
    ) -> None:
        self.app = app
        self.token = token
        self.origins = origins
        self.attempts = attempts
        # The cookie does not hold the token itself.
        self.cookie = hashlib.sha256(f"stairwright {token}".encode()).hexdigest()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        try:
            welcome = self._check(scope)
        except Problem as problem:
            await problem.response()(scope, receive, send)
            return
        await (welcome or self.app)(scope, receive, send)

    def _check(self, scope: Scope) -> Response | None:
        """None for whoever may come in; a redirection for whoever has the token in the address.

        Raises:
            Problem: 401, 403 or 429 for everybody else.
        """
        headers = Headers(scope=scope)
        safe = scope["type"] == "http" and scope["method"] in _SAFE
        origin = headers.get("origin")
        if not safe and origin and not same_site(origin, headers.get("host"), self.origins):
            raise Problem(403, f"requests from {origin} are not allowed", kind="origin")
        if not self.token or scope["path"] in _OPEN:
            return None
        query = parse_qsl(scope["query_string"].decode("latin-1"), keep_blank_values=True)
        asked = dict(query).get("token", "") if safe else ""
        given = [(_bearer(headers), self.token), (_cookie(headers), self.cookie)]
        self._admit(owner_of(scope), [*given, (asked, self.token)])
        if asked and _same(asked, self.token):
            return self._welcome(scope, [pair for pair in query if pair[0] != "token"])
        return None

    def _admit(self, address: str, secrets: Sequence[tuple[str, str]]) -> None:
        """Pass if one of the secrets that were given, each with the right one, is right.

        Raises:
            Problem: 401 if none is, 429 if this address has tried too many wrong ones.
        """
        tried = [(given, right) for given, right in secrets if given]
        wait = self.attempts.wait(address) if tried else 0.0
        if wait > 0.0:  # for the right one too, or the answers would tell which one it is
            headers = {"retry-after": str(math.ceil(wait))}
            detail = "too many wrong tokens came from this address"
            raise Problem(429, detail, kind="attempts", headers=headers)
        if any(_same(given, right) for given, right in tried):
            return
        for given, _ in tried:
            self.attempts.add_wrong(address, given)
        challenge = {"www-authenticate": 'Bearer realm="stairwright"'}
        detail = "this needs the token: Authorization: Bearer …, or open /?token=…"
        raise Problem(401, detail, kind="token", headers=challenge)

    def _welcome(self, scope: Scope, query: list[tuple[str, str]]) -> Response:
        """Keep the token in a cookie and take it out of the address."""
        path = "/" + scope["path"].lstrip("/")  # never another host
        target = path + (f"?{urlencode(query)}" if query else "")
        response = RedirectResponse(target, 303)
        secure = scope.get("scheme") == "https"
        response.set_cookie(_COOKIE, self.cookie, httponly=True, samesite="lax", secure=secure)
        return response


def _bearer(headers: Headers) -> str:
    scheme, _, given = headers.get("authorization", "").partition(" ")
    return given.strip() if scheme.lower() == "bearer" else ""


def _cookie(headers: Headers) -> str:
    try:
        morsel = SimpleCookie(headers.get("cookie", "")).get(_COOKIE)
    except CookieError:
        return ""
    return "" if morsel is None else morsel.value


def _same(given: str, secret: str) -> bool:
    return hmac.compare_digest(given.encode("utf-8", "replace"), secret.encode())
