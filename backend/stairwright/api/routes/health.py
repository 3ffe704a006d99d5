"""Is the service ready, and how is it doing?"""

from __future__ import annotations

import asyncio

from fastapi import APIRouter, Response

from stairwright import __version__
from stairwright.api.bodies import Health
from stairwright.api.deps import Service
from stairwright.api.problems import Problem, describe

router = APIRouter(tags=["service"])
metrics_router = APIRouter(include_in_schema=False)


@router.get("/healthz", responses=describe(503))
async def healthz(services: Service) -> Health:
    """200 when plans are answered at once; before that they wait, and 503 says what for."""
    await asyncio.to_thread(services.store.ready)
    if not services.readiness.ready:
        soon = {"retry-after": "1"}
        raise Problem(503, services.readiness.text, kind="starting", headers=soon)
    return Health(version=__version__, read_only=services.store.read_only)


@metrics_router.get("/metrics")
async def metrics(services: Service) -> Response:
    """Figures for Prometheus."""
    content = await asyncio.to_thread(services.metrics.text)
    return Response(content, media_type="text/plain; version=0.0.4")
