"""Is the service ready?"""

from __future__ import annotations

from fastapi import APIRouter

from stairwright import __version__
from stairwright.api.bodies import Health

router = APIRouter(tags=["service"])


@router.get("/healthz")
async def healthz() -> Health:
    """Answers as soon as the service can take requests."""
    return Health(version=__version__)
