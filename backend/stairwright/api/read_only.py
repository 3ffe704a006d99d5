"""What is refused while nothing can be saved; reading and planning go on."""

from __future__ import annotations

from starlette.types import ASGIApp, Receive, Scope, Send

from .middleware import PREFIX
from .problems import Problem

_STORED = tuple(
    f"{PREFIX}/{kind}/"
    for kind in ("terrains", "robots", "plans", "rollouts", "trials", "margins", "jobs", "studies")
)
_WORK = (f"{PREFIX}/rollouts", f"{PREFIX}/trials", f"{PREFIX}/margins", f"{PREFIX}/studies")


class ReadOnly:
    """Answers 503 to what would be saved or removed, with what is wrong and what to do."""

    def __init__(self, app: ASGIApp, reason: str) -> None:
        self.app = app
        self.reason = reason

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "http" and _saves(scope["method"], scope["path"]):
            await Problem(503, self.reason, kind="read-only").response()(scope, receive, send)
        else:
            await self.app(scope, receive, send)


def _saves(method: str, path: str) -> bool:
    if method in ("PUT", "PATCH", "DELETE"):
        return path.startswith(_STORED)
    return method == "POST" and path in _WORK
