"""What plans and rollouts have in common: lists, documents and exports of stored results."""

from __future__ import annotations

import asyncio
import gzip
import hashlib
from collections.abc import Mapping
from typing import Any, Literal
from urllib.parse import quote

from fastapi import Request, Response

from stairwright.api.bodies import StoredEntry
from stairwright.api.problems import not_found
from stairwright.api.responses import models_json, not_modified, stored_json
from stairwright.api.services import EXPORT_DEADLINE, Services
from stairwright.documents import Model
from stairwright.export.table import FORMATS, Format
from stairwright.export.table import Kind as Exported
from stairwright.jobs import work
from stairwright.storage.documents import Entry, Kind


def files(formats: Mapping[str, Format[Any]]) -> dict[int | str, dict[str, Any]]:
    """OpenAPI's word for a download in one of several formats."""
    binary = {"schema": {"type": "string", "format": "binary"}}
    types = [each.media_type.split(";")[0] for each in formats.values()]
    content = {each: {} if each == "application/json" else binary for each in types}
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


async def delete(services: Services, kind: Kind, document_id: str) -> None:
    """Remove a stored document.

    Raises:
        Problem: 404 if there is none (any more).
    """
    if not await asyncio.to_thread(services.store.delete, kind, document_id):
        raise not_found(kind, document_id)


async def document(request: Request, services: Services, kind: Kind, document_id: str) -> Response:
    """The document itself."""
    entry, packed = await load(services, kind, document_id)
    return await stored_json(request, packed, entry.digest)


async def export(
    request: Request,
    services: Services,
    kind: Literal["plan", "rollout"],
    document_id: str,
    format_name: str,
    rate: float | None = None,
) -> Response:
    """A stored document in another format, as a download."""
    entry, packed = await load(services, kind, document_id)
    return await _download(
        request, services, kind, (document_id, entry.digest[:32]), packed, format_name, rate
    )


async def export_document(
    request: Request, services: Services, kind: Exported, name: str, document: Model, form: str
) -> Response:
    """A document that is at hand in another format, as a download."""
    content = document.model_dump_json().encode()
    digest = hashlib.sha256(content).hexdigest()[:32]
    packed = gzip.compress(content, 1)
    return await _download(request, services, kind, (name, digest), packed, form, None)


def _attachment(name: str) -> str:
    """RFC 6266: headers hold ASCII, names of robots any script."""
    plain = name.encode("ascii", "replace").decode().replace("?", "_")
    full = "" if plain == name else f"; filename*=UTF-8''{quote(name, safe='')}"
    return f'attachment; filename="{plain}"{full}'


async def _download(
    request: Request,
    services: Services,
    kind: Exported,
    called: tuple[str, str],
    packed: bytes,
    format_name: str,
    rate: float | None,
) -> Response:
    """`packed`, of that name and digest, as a file in that format."""
    chosen, (name, digest) = FORMATS[kind][format_name], called
    etag = f'"{digest}-{format_name}{"" if rate is None else f"-{rate!r}"}"'
    headers = {
        "etag": etag,
        "cache-control": "no-cache",
        "content-disposition": _attachment(f"{name}{chosen.suffix}"),
        "x-content-type-options": "nosniff",
    }
    if not_modified(request, etag):
        return Response(status_code=304, headers=headers)
    async with services.planning.queue.slot("export"):
        content = await services.plan_pool.run(
            work.export, packed, kind, format_name, rate, deadline=EXPORT_DEADLINE
        )
    return Response(content, headers=headers, media_type=chosen.media_type)
