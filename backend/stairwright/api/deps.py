"""What routes ask for: services, who asks, and names resolved to documents."""

from __future__ import annotations

import asyncio
import hashlib
from collections.abc import AsyncIterator, Callable, Sequence
from typing import Annotated, TypeVar

from fastapi import Depends, Header, Query, Request

from stairwright.errors import InputError
from stairwright.library import load_robot, load_terrain, robots, terrains
from stairwright.robot.description import Robot
from stairwright.storage.idempotency import Verdict
from stairwright.storage.saved import Saved
from stairwright.terrain.generation import Parameters, generate
from stairwright.terrain.profile import Terrain

from .middleware import owner_of
from .problems import FieldError, Problem
from .services import Services

D = TypeVar("D", Terrain, Robot)


async def get_services(request: Request) -> Services:
    """The application's services."""
    services: Services = request.app.state.services
    return services


async def get_owner(
    request: Request,
    services: Annotated[Services, Depends(get_services)],
    stairwright_session: Annotated[
        str | None,
        Header(max_length=64, description="an open session: sessions take turns in the queues"),
    ] = None,
) -> str:
    """Who asks, for the fair queues: an open session, or else the client's address."""
    address = owner_of(request.scope)
    known = stairwright_session is not None and stairwright_session in services.sessions
    return f"{address} {stairwright_session}" if known else address


async def require_json(request: Request) -> None:
    """Refuse bodies of another type, which browsers would send across origins unasked."""
    kind = request.headers.get("content-type", "").split(";")[0].strip().lower()
    if kind != "application/json" and not (
        kind.startswith("application/") and kind.endswith("+json")
    ):
        raise Problem(415, "the body must be application/json", kind="media-type")


Service = Annotated[Services, Depends(get_services)]
Owner = Annotated[str, Depends(get_owner)]
JSON_BODY = Depends(require_json)
Limit = Annotated[int, Query(ge=1, le=1000, description="at most this many")]
Offset = Annotated[int, Query(ge=0, le=10**9, description="after this many")]


class Idempotency:
    """The key that a request brought, if any; `result` is remembered for the next one."""

    def __init__(self, earlier: str | None = None) -> None:
        self.earlier = earlier
        self.result: str | None = None


async def idempotency(
    request: Request,
    services: Service,
    idempotency_key: Annotated[
        str | None,
        Header(
            min_length=1,
            max_length=255,
            pattern=r"^[\x21-\x7e]+$",
            description="a repeated request with the same key does its work once",
        ),
    ] = None,
) -> AsyncIterator[Idempotency]:
    """Claim the key before the work; remember the result after it.

    Raises:
        Problem: 409 while the first request is at work, 422 if the key belongs to another body.
    """
    if idempotency_key is None or services.store.read_only:  # nothing is kept, nor are keys
        yield Idempotency()
        return
    keys, scope = services.store.idempotency, request.url.path
    fingerprint = hashlib.sha256(await request.body()).hexdigest()
    verdict, earlier = await asyncio.to_thread(keys.begin, scope, idempotency_key, fingerprint)
    if verdict is Verdict.BUSY:
        raise Problem(
            409,
            "the first request with this key is at work",
            kind="idempotency",
            headers={"retry-after": "1"},
        )
    if verdict is Verdict.OTHER:
        message = "this key came with another body before"
        field = FieldError(field="idempotency-key", message=message)
        raise Problem(422, message, kind="idempotency", errors=[field])
    claim = Idempotency(earlier)
    try:
        yield claim
    finally:
        if claim.result is not None:
            await asyncio.to_thread(keys.finish, scope, idempotency_key, claim.result)
        elif verdict is Verdict.NEW:
            await asyncio.to_thread(keys.release, scope, idempotency_key)


# The claim must be settled before the answer leaves, or a quick repetition would find it open.
Idempotent = Annotated[Idempotency, Depends(idempotency, scope="function")]


def resolve_terrain(services: Services, source: str | Parameters | Terrain) -> Terrain:
    """A preset or saved terrain by name; one of these measures; a document as it is. Never a file.

    Raises:
        Problem: 422 if there is none of that name.
        InputError: If the measures make none.
    """
    if isinstance(source, Terrain):
        return source
    if not isinstance(source, str):
        try:
            return generate(source)
        except InputError as error:
            raise error.within("terrain") from None
    return _named("terrain", source, terrains(), load_terrain, services.store.terrains)


def resolve_robot(services: Services, source: str | Robot) -> Robot:
    """A preset or saved robot by name; a document as it is. Never a file.

    Raises:
        Problem: 422 if there is none of that name.
    """
    if isinstance(source, Robot):
        return source
    return _named("robot", source, robots(), load_robot, services.store.robots)


def _named(
    kind: str, name: str, presets: Sequence[str], load: Callable[[str], D], saved: Saved[D]
) -> D:
    if name in presets:
        return load(name)
    if (found := saved.get(name)) is not None:
        return found
    known = [*presets, *saved.names()]
    shown = ", ".join(known[:30]) + (", …" if len(known) > 30 else "")
    message = f"no {kind} is called {name!r}; there are: {shown}"
    raise Problem(
        422,
        f"{kind}: {message}",
        kind="bad-input",
        errors=[FieldError(field=kind, message=message)],
    )
