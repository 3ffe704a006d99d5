"""Answers: stored documents as they lie on disk, entity tags, pages."""

from __future__ import annotations

import gzip
import hashlib
from collections.abc import Mapping, Sequence
from typing import Any

from fastapi import Request, Response
from pydantic import BaseModel
from starlette.concurrency import run_in_threadpool

from .settings import LOOPBACK

WORTH_PACKING = 1000  # bytes


def not_modified(request: Request, etag: str) -> bool:
    """Whether the client has this version already."""
    wanted = request.headers.get("if-none-match", "")
    tags = {tag.strip().removeprefix("W/") for tag in wanted.split(",")}
    return etag in tags or "*" in tags


async def stored_json(
    request: Request, packed: bytes, digest: str, headers: Mapping[str, str] | None = None
) -> Response:
    """A gzipped JSON document; sent as it lies to whoever takes gzip."""
    etag = f'"{digest[:32]}"'
    common = {"etag": etag, "vary": "Accept-Encoding", "cache-control": "no-cache"}
    common.update(headers or {})
    if request.method == "GET" and not_modified(request, etag):
        return Response(status_code=304, headers=common)
    if _takes_gzip(request):
        common["content-encoding"] = "gzip"
        return Response(packed, headers=common, media_type="application/json")
    content = await run_in_threadpool(gzip.decompress, packed)
    return Response(content, headers=common, media_type="application/json")


async def fresh_json(
    request: Request, content: bytes, digest: str, headers: Mapping[str, str] | None = None
) -> Response:
    """A JSON document that was made this moment, so somebody waits for it.

    On this machine compressing takes longer than sending.
    """
    common = {"etag": f'"{digest[:32]}"', "vary": "Accept-Encoding", "cache-control": "no-cache"}
    common.update(headers or {})
    if _takes_gzip(request) and len(content) >= WORTH_PACKING and not _is_local(request):
        common["content-encoding"] = "gzip"
        content = await run_in_threadpool(gzip.compress, content, 1)
    return Response(content, headers=common, media_type="application/json")


def _is_local(request: Request) -> bool:
    """Whether the client is on this machine and no proxy on the way to another one."""
    client = request.client
    forwarded = {"forwarded", "x-forwarded-for", "via"} & set(request.headers.keys())
    return client is not None and client.host in LOOPBACK and not forwarded


def _takes_gzip(request: Request) -> bool:
    for part in request.headers.get("accept-encoding", "").split(","):
        name, _, weight = part.partition(";")
        if name.strip().lower() in ("gzip", "*"):
            return weight.replace(" ", "").lower() not in ("q=0", "q=0.0", "q=0.00", "q=0.000")
    return False


def model_json(
    request: Request,
    model: BaseModel,
    status: int = 200,
    headers: Mapping[str, str] | None = None,
) -> Response:
    """A model with an entity tag of its content."""
    return _tagged(request, model.model_dump_json().encode(), status, headers)


def models_json(
    request: Request,
    models: Sequence[BaseModel],
    *,
    total: int,
    limit: int,
    offset: int,
) -> Response:
    """One page of a list: how many there are in all in X-Total-Count, the next page in Link."""
    headers = {"x-total-count": str(total)}
    if offset + limit < total:
        following = request.url.include_query_params(limit=limit, offset=offset + limit)
        headers["link"] = f'<{following.path}?{following.query}>; rel="next"'
    content = b"[" + b",".join(model.model_dump_json().encode() for model in models) + b"]"
    return _tagged(request, content, 200, headers)


def accepted_json(model: BaseModel, place: str) -> Response:
    """202 for what has only begun: its state now, and where to ask again."""
    headers = {"location": place, "retry-after": "1"}
    return Response(model.model_dump_json(), 202, headers=headers, media_type="application/json")


def _tagged(
    request: Request, content: bytes, status: int, headers: Mapping[str, str] | None
) -> Response:
    etag = f'"{hashlib.sha256(content).hexdigest()[:32]}"'
    common: dict[str, Any] = {"etag": etag, "cache-control": "no-cache", **(headers or {})}
    if request.method == "GET" and not_modified(request, etag):
        return Response(status_code=304, headers=common)
    return Response(content, status, common, media_type="application/json")
