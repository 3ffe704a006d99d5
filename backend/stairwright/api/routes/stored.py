"""What plans and rollouts have in common: lists, documents and exports of stored results."""

from __future__ import annotations

import asyncio
import gzip
import hashlib
from collections.abc import Mapping
from typing import Annotated, Any, Literal
from urllib.parse import quote

from fastapi import APIRouter, Depends, Path, Query, Request, Response

from stairwright.api.bodies import EntryChanges, StoredEntry
from stairwright.api.deps import JSON_BODY, Limit, Offset, Service
from stairwright.api.problems import describe, not_found
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


class Listed:
    """Which stored results a list shows."""

    def __init__(
        self,
        limit: Limit = 100,
        offset: Offset = 0,
        search: Annotated[
            str,
            Query(max_length=200, description="words in name, note, terrain, robot or outcome"),
        ] = "",
        pinned: Annotated[bool | None, Query(description="only those pinned, or not")] = None,
    ) -> None:
        self.limit, self.offset, self.search, self.pinned = limit, offset, search, pinned


Listing = Annotated[Listed, Depends(Listed)]


def serve(
    router: APIRouter,
    kind: Kind,
    model: type[Model],
    *,
    get: str,
    save: str,
    delete: str,
    some: str,
) -> None:
    """Routes that list stored results of a kind, answer one, note something about it, remove it.

    Args:
        router: Its prefix says what many of them are called.
        kind: What one is called.
        model: The document of one.
        get: What the API says of the route that answers one.
        save: Of the one that notes something.
        delete: Of the one that removes one.
        some: What many are called in words.
    """
    many, place = router.prefix.removeprefix("/"), f"/{{{kind}_id}}"
    key = Path(alias=f"{kind}_id", max_length=64, examples=[f"{kind[0]}-0123456789abcdef"])

    @router.get(
        "",
        name=f"list_{many}",
        description=f"Stored {some}, newest first.",
        response_model=list[StoredEntry],
    )
    async def _list(request: Request, services: Service, listed: Listing) -> Response:
        limit, offset = listed.limit, listed.offset
        entries, total = await asyncio.to_thread(
            services.store.documents.page, kind, limit, offset, listed.search, listed.pinned
        )
        return models_json(
            request, [_shown(each) for each in entries], total=total, limit=limit, offset=offset
        )

    @router.get(
        place, name=f"get_{kind}", description=get, response_model=model, responses=describe(404)
    )
    async def _get(request: Request, services: Service, document_id: str = key) -> Response:
        entry, packed = await load(services, kind, document_id)
        return await stored_json(request, packed, entry.digest)

    @router.patch(
        place,
        name=f"save_{kind}_notes",
        description=save,
        dependencies=[JSON_BODY],
        responses=describe(404, 415),
    )
    async def _save(
        services: Service, changes: EntryChanges, document_id: str = key
    ) -> StoredEntry:
        noted = changes.model_dump(exclude_none=True)
        documents = services.store.documents
        entry = await asyncio.to_thread(documents.annotate, kind, document_id, **noted)
        if entry is None:
            raise not_found(kind, document_id)
        return _shown(entry)

    @router.delete(
        place,
        name=f"delete_{kind}",
        description=delete,
        status_code=204,
        responses=describe(404),
    )
    async def _delete(services: Service, document_id: str = key) -> None:
        if not await asyncio.to_thread(services.store.delete, kind, document_id):
            raise not_found(kind, document_id)


def _shown(entry: Entry) -> StoredEntry:
    return StoredEntry(**{name: getattr(entry, name) for name in StoredEntry.model_fields})


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
