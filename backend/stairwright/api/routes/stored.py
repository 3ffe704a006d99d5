"""What plans and rollouts have in common: lists, documents and exports of stored results."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from typing import Any

from fastapi import Request, Response

from stairwright.api.bodies import StoredEntry
from stairwright.api.problems import Problem, not_found
from stairwright.api.responses import models_json, not_modified, stored_json
from stairwright.api.services import EXPORT_DEADLINE, Services
from stairwright.jobs import work
from stairwright.storage.documents import Entry, Kind


def files(media_types: Sequence[str]) -> dict[int | str, dict[str, Any]]:
    """OpenAPI's word for a download in one of several formats."""
    binary = {"schema": {"type": "string", "format": "binary"}}
    content = {each: {} if each == "application/json" else binary for each in media_types}
    return {200: {"description": "The file", "content": content}}


async def listing(
    request: Request, services: Services, kind: Kind, limit: int, offset: int
) -> Response:
    """Newest first."""
    entries, total = await asyncio.to_thread(services.store.documents.page, kind, limit, offset)
    shown = [
        StoredEntry(id=each.id, digest=each.digest, created=each.created, summary=each.summary)
        for each in entries
    ]
    return models_json(request, shown, total=total, limit=limit, offset=offset)


async def load(services: Services, kind: Kind, document_id: str) -> tuple[Entry, bytes]:
    """A stored document's entry and gzipped JSON.

    Raises:
        Problem: 404 if there is none (any more).
    """
    entry = await asyncio.to_thread(services.store.documents.get, kind, document_id)
    if entry is None:
        raise not_found(kind, document_id)
    try:
        return entry, await asyncio.to_thread(services.store.artefacts.packed, entry.digest)
    except FileNotFoundError:
        raise not_found(kind, document_id) from None


async def document(request: Request, services: Services, kind: Kind, document_id: str) -> Response:
    """The document itself."""
    entry, packed = await load(services, kind, document_id)
    return await stored_json(request, packed, entry.digest)


async def export(
    request: Request, services: Services, kind: Kind, document_id: str, format_name: str
) -> Response:
    """The document in another format, as a download."""
    try:
        from stairwright.export import formats
    except ImportError:
        raise Problem(503, "this service has no exports", kind="no-export") from None
    known = formats.PLAN_FORMATS if kind == "plan" else formats.ROLLOUT_FORMATS
    if format_name not in known:
        raise Problem(422, f"format: there are: {', '.join(known)}", kind="bad-input")
    chosen = known[format_name]
    entry, packed = await load(services, kind, document_id)
    etag = f'"{entry.digest[:32]}-{format_name}"'
    name = f"{document_id}{'' if chosen.suffix.startswith('.') else '.'}{chosen.suffix}"
    headers = {
        "etag": etag,
        "cache-control": "no-cache",
        "content-disposition": f'attachment; filename="{name}"',
        "x-content-type-options": "nosniff",
    }
    if not_modified(request, etag):
        return Response(status_code=304, headers=headers)
    async with services.planning.queue.slot("export"):
        content = await services.plan_pool.run(
            work.export, packed, kind, format_name, deadline=EXPORT_DEADLINE
        )
    return Response(content, headers=headers, media_type=chosen.media_type)
