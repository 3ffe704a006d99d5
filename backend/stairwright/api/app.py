"""The application: settings in, routes and middleware put together."""

from __future__ import annotations

from fastapi import APIRouter, FastAPI

from stairwright import __version__

from . import problems
from .routes import health, page, plans, robots, terrains, tuning
from .settings import Settings

PREFIX = "/api/v1"
DESCRIPTION = """Plans and simulates how a wheel-legged robot climbs stairs, ramps and any profile.
SI units and radians; x forward, y left, z up; nose-up pitch is negative."""


def create_app(settings: Settings | None = None) -> FastAPI:
    """The ASGI application; without `settings` they come from the environment."""
    settings = settings or Settings.from_env()
    app = FastAPI(
        title="Stairwright",
        version=__version__,
        description=DESCRIPTION,
        openapi_url=f"{PREFIX}/openapi.json",
        docs_url=f"{PREFIX}/docs",
        redoc_url=None,
        responses=problems.describe(400, 413, 422),
    )
    app.state.settings = settings
    problems.install(app)
    api = APIRouter(prefix=PREFIX)
    for routes in (health, tuning, robots, terrains, plans):
        api.include_router(routes.router)
    app.include_router(api)
    app.include_router(health.router, include_in_schema=False)
    page.mount(app, settings.page)
    return app
