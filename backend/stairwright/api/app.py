"""The application: settings in, routes and middleware put together."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from fastapi import APIRouter, Depends, FastAPI

from stairwright import __version__

from . import openapi, problems
from .attempts import Attempts
from .described import operation_id
from .gate import Gate
from .head import Head
from .headers import SecurityHeaders
from .hosts import Hosts
from .last_resort import LastResort
from .middleware import PREFIX, Compress, LimitBody, Observe
from .origins import Cors
from .queries import known_query
from .read_only import ReadOnly
from .routes import (
    designs,
    health,
    jobs,
    live,
    margins,
    page,
    plans,
    robots,
    rollouts,
    scene,
    sessions,
    studies,
    study_cells,
    terrains,
    trials,
    tuning,
)
from .services import Services
from .settings import Settings

DESCRIPTION = """Plans and simulates how a wheel-legged robot climbs stairs, ramps and any profile.
SI units and radians; x forward, y left, z up; nose-up pitch is negative."""


def create_app(settings: Settings | None = None) -> FastAPI:
    """The ASGI application; without `settings` they come from the environment.

    Raises:
        InputError: If a setting is bad or the data folder cannot be used.
    """
    settings = settings or Settings.from_env()
    services = Services(settings)

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        _complete(app)
        await services.start()
        yield
        await services.stop()

    app = FastAPI(
        title="Stairwright",
        version=__version__,
        description=DESCRIPTION,
        openapi_url=f"{PREFIX}/openapi.json",
        docs_url=None,
        redoc_url=None,
        lifespan=lifespan,
        responses=problems.describe(400, 401, 403, 413, 422),
        redirect_slashes=False,
        generate_unique_id_function=operation_id,
    )
    app.state.services = services
    problems.install(app)
    openapi.install(app, token=bool(settings.token))
    # The last one added is the outermost.
    app.add_middleware(Compress)
    if services.store.read_only:
        app.add_middleware(ReadOnly, reason=services.store.read_only)
    app.add_middleware(
        LimitBody, limit=settings.body_limit, upload_limit=settings.upload_limit + 65536
    )
    app.add_middleware(LastResort)  # its answers too get the headers of those around it
    app.add_middleware(Head)
    origins, attempts = settings.allowed_origins, Attempts(settings.token_attempts)
    app.add_middleware(Gate, token=settings.token, origins=origins, attempts=attempts)
    app.add_middleware(Cors, origins=origins)
    app.add_middleware(Hosts, allowed=settings.allowed_hosts)
    app.add_middleware(SecurityHeaders)
    app.add_middleware(Observe, metrics=services.metrics)
    api = APIRouter(prefix=PREFIX, dependencies=[Depends(known_query)])
    for routes in (
        health,
        tuning,
        robots,
        terrains,
        plans,
        live,
        rollouts,
        trials,
        margins,
        jobs,
        studies,
        study_cells,
        designs,
        sessions,
    ):
        api.include_router(routes.router)
    app.include_router(api)
    app.include_router(health.router, include_in_schema=False)
    app.include_router(health.metrics_router)
    app.include_router(scene.router)
    page.mount(app, settings.page, f"{PREFIX}/docs")
    return app


def _complete(app: FastAPI) -> None:
    """Have FastAPI finish its routes, which it would leave to the first request: 20 ms."""
    nowhere = {"type": "http", "method": "GET", "path": "/-", "root_path": "", "headers": []}
    for route in app.routes:
        route.matches(dict(nowhere))
