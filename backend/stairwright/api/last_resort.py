"""An answer to whatever nobody else has caught, and one line in the log for it.

Starlette's own last resort answers and then raises again, so that the server logs it again.
"""

from __future__ import annotations

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from .problems import problem_of


class LastResort:
    """Answers with a problem document, unless an answer has begun already."""

    def __init__(self, app: ASGIApp) -> None:
        self.app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        begun = False

        async def noting(message: Message) -> None:
            nonlocal begun
            begun = begun or message["type"] == "http.response.start"
            await send(message)

        try:
            await self.app(scope, receive, noting)
        except Exception as error:
            if begun:
                raise  # the server closes the connection, and logs it
            await problem_of(error).response()(scope, receive, send)
