"""Design searches that were carried out on this machine, with what they have found so far."""

from __future__ import annotations

import asyncio
import hashlib
from typing import Annotated

from fastapi import APIRouter, Path, Request, Response

from stairwright.api.deps import Limit, Offset, Service
from stairwright.api.problems import describe, not_found
from stairwright.api.responses import fresh_json, models_json, not_modified
from stairwright.studies.design_result import DesignResult
from stairwright.studies.design_shelf import DesignSummary, kept_results, read_result

router = APIRouter(prefix="/designs", tags=["studies"])
Id = Annotated[str, Path(max_length=80, pattern=r"^d-[0-9a-f]+$", examples=["d-0123456789abcdef"])]


@router.get("", response_model=list[DesignSummary])
async def list_designs(
    request: Request, services: Service, limit: Limit = 100, offset: Offset = 0
) -> Response:
    """Searches of `stairwright design` in this data folder, newest first; those at work too."""
    found = await asyncio.to_thread(kept_results, services.store.studies.folder)
    shown = found[offset : offset + limit]
    return models_json(request, shown, total=len(found), limit=limit, offset=offset)


@router.get("/{design_id}", response_model=DesignResult, responses=describe(404))
async def get_design(request: Request, services: Service, design_id: Id) -> Response:
    """Every design that was tried so far, and the best ones with their robots."""
    content = await asyncio.to_thread(read_result, services.store.studies.folder, design_id)
    if content is None:
        raise not_found("design search", design_id)
    digest = hashlib.sha256(content).hexdigest()
    if not_modified(request, f'"{digest[:32]}"'):
        return Response(status_code=304)
    return await fresh_json(request, content, digest)
