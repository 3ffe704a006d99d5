"""Which web pages may call: the service's own, and those of listed origins."""

from __future__ import annotations

from collections.abc import Collection
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.middleware.cors import CORSMiddleware
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from .settings import LOOPBACK

_METHODS = ("GET", "HEAD", "POST", "PUT", "PATCH", "DELETE")
_ASKED = (
    "Authorization",
    "Content-Type",
    "Idempotency-Key",
    "If-None-Match",
    "Last-Event-ID",
    "Stairwright-Session",
    "X-Request-ID",
)
_TOLD = (
    "Content-Disposition",
    "Content-Location",
    "ETag",
    "Link",
    "Location",
    "Retry-After",
    "WWW-Authenticate",
    "X-Request-ID",
    "X-Total-Count",
)


class Cors:
    """Lets browsers show answers to pages of the listed origins, and of no other.

    Such a page brings the token itself, as `Authorization`: the cookie is for the service's own.
    """

    def __init__(self, app: ASGIApp, origins: Collection[str]) -> None:
        self.app = app
        self.origins = origins
        self.listed = CORSMiddleware(
            app,
            allow_origins=origins,
            allow_methods=_METHODS,
            allow_headers=_ASKED,
            expose_headers=_TOLD,
            allow_private_network=True,
        )

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http" or not self.origins:
            await self.app(scope, receive, send)
        elif Headers(scope=scope).get("origin") in self.origins:
            await self.listed(scope, receive, send)
        else:

            async def send_varied(message: Message) -> None:
                if message["type"] == "http.response.start":
                    MutableHeaders(scope=message).add_vary_header("Origin")
                await send(message)

            await self.app(scope, receive, send_varied)


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
