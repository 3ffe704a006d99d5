"""Which names this service answers to.

A page of evil.example may have its own name lead to this machine after it has been loaded (DNS
rebinding); its requests then come from the same origin as far as the browser can tell. What they
cannot hide is the name: the Host header says evil.example.
"""

from __future__ import annotations

import re
from collections.abc import Collection

from starlette.types import ASGIApp, Receive, Scope, Send

from .problems import Problem, printable

_HOST = re.compile(r"(\[[0-9a-f:.]+\]|[\w.-]+)(:\d{0,5})?", re.ASCII | re.IGNORECASE)


class Hosts:
    """Answers 421 to requests, WebSockets too, that are addressed to another name."""

    def __init__(self, app: ASGIApp, allowed: Collection[str]) -> None:
        self.app = app
        self.allowed = frozenset(allowed)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        problem = None if scope["type"] == "lifespan" else self._problem(scope)
        if problem is None:
            await self.app(scope, receive, send)
        else:
            await problem.response()(scope, receive, send)

    def _problem(self, scope: Scope) -> Problem | None:
        given = [value for name, value in scope["headers"] if name == b"host"]
        if len(given) != 1:
            return Problem(400, "a request needs exactly one Host header", kind="host")
        name = host_name(given[0].decode("latin-1"))
        if name is not None and (name in self.allowed or name == _address(scope)):
            return None
        detail = (
            f"this service does not answer to the name {printable(given[0].decode('latin-1'))!r}; "
            "STAIRWRIGHT_HOSTS lists the names that it answers to"
        )
        return Problem(421, detail, kind="host")


def host_name(host: str) -> str | None:
    """The name or address in a Host header, without port and brackets; None if it is none."""
    match = _HOST.fullmatch(host)
    return match and match[1].strip("[]").rstrip(".").lower()


def _address(scope: Scope) -> str | None:
    """The address that the client has connected to: no name, so none that could be rebound."""
    server = scope.get("server")
    return str(server[0]).lower().removeprefix("::ffff:") if server else None
