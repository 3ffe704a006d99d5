"""The page: static files, built by `./dev build` or shipped in the wheel."""

from __future__ import annotations

from pathlib import Path

from fastapi import FastAPI
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import PlainTextResponse, RedirectResponse, Response
from starlette.routing import Match, Mount
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from stairwright.api.headers import PAGE_POLICY

NOT_BUILT = "The page is not built. In a checkout: ./dev build. REST works: /api/v1/openapi.json\n"
DOCS = "docs.html"


class Page(StaticFiles):
    """Files with hashed names are kept by browsers for good, the others are asked for again."""

    def __init__(self, folder: Path) -> None:
        super().__init__(directory=folder, html=True, check_dir=False)
        self.folder = folder

    async def check_config(self) -> None:
        """A folder that is not there is answered for, see `get_response`."""

    async def get_response(self, path: str, scope: Scope) -> Response:
        """One file, or a sentence if the page has not been built."""
        document = {".": "index.html", DOCS: DOCS}.get(path)
        if document and not (self.folder / document).is_file():
            return PlainTextResponse(NOT_BUILT, 503)
        if "\0" in path:
            raise HTTPException(404)
        response = await super().get_response(path, scope)
        forever = path.startswith("assets/") and response.status_code == 200
        cache = "public, max-age=31536000, immutable" if forever else "no-cache"
        response.headers["cache-control"] = cache
        response.headers["content-security-policy"] = PAGE_POLICY
        return response


class _PageRoute(Mount):
    """Everything but REST, so that a wrong method there is a 405 and not a missing file."""

    def matches(self, scope: Scope) -> tuple[Match, Scope]:
        """Whether the page's folder answers."""
        path = scope.get("path", "")
        if scope["type"] == "http" and path.startswith(("/api/", "/scene/")):
            return Match.NONE, {}
        return super().matches(scope)


def mount(app: FastAPI, folder: Path, docs: str) -> None:
    """Serve the page at /, and from `docs` lead to the API's; must come after all other routes."""

    async def lead_to_docs(_: Request) -> Response:
        return RedirectResponse(f"/{DOCS}")

    app.add_route(docs, lead_to_docs, include_in_schema=False)
    app.router.routes.append(_PageRoute("/", Page(folder), name="page"))
