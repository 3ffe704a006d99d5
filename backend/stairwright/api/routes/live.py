"""Plans as a hand drags: questions over one connection, of which only the newest counts.

A message is ``{"id": 7, "body": {…}}`` with the body of POST /plans; the answer is
``{"id": 7, "status": 200, "plan": {…}}``, or ``problem`` instead of ``plan`` with the status that
REST would have. A newer question takes the place of one that is not answered yet, which gets no
answer then; one without a body only does that. With ``"keep": false`` the answer comes sooner: key
poses are not certified, what would open an infeasible path is not looked for, and the plan is not
stored, so its id leads nowhere.
"""

from __future__ import annotations

import asyncio
import gzip
import secrets
import time
from typing import Any

import orjson
from fastapi import APIRouter, WebSocket
from pydantic import Field, ValidationError

from stairwright.api.bodies import PlanRequest
from stairwright.api.middleware import PLANS_PATH, owner_of, record, request_id
from stairwright.api.problems import Problem, from_validation, problem_of
from stairwright.api.services import Services
from stairwright.documents import Model

from .plans import answered, previewed

router = APIRouter(prefix="/plans")
_PATH = f"{PLANS_PATH}/live"


class LiveQuestion(Model):
    """One message of the client."""

    id: int = Field(ge=0, le=2**53)
    body: PlanRequest | None = None
    keep: bool = True


@router.websocket("/live")
async def live(websocket: WebSocket) -> None:
    """One client. The gate has checked token and Origin already."""
    await websocket.accept()
    answering: asyncio.Task[None] | None = None
    try:
        while (message := await websocket.receive())["type"] == "websocket.receive":
            if answering is not None:
                answering.cancel()
            content = message.get("text") or message.get("bytes") or b""
            answering = asyncio.create_task(_answer(websocket, content))
    finally:
        if answering is not None:
            answering.cancel()


async def _answer(websocket: WebSocket, content: str | bytes) -> None:
    services: Services = websocket.app.state.services
    request_id.set(secrets.token_hex(8))
    start, status, number = time.perf_counter(), 200, None
    try:
        asked = _parsed(content, services.settings.body_limit)
        number = asked.get("id")
        question = _question(asked)
        if question.body is None:
            return
        plan = await _plan(services, question.body, question.keep, owner_of(websocket.scope))
        head = orjson.dumps({"id": number, "status": status})
        reply = head[:-1] + b',"plan":' + plan + b"}"
    except Exception as error:  # noqa: BLE001 - told to the client, and to the log where it must
        problem = problem_of(error)
        status = problem.status
        known = number if isinstance(number, int) else None
        reply = orjson.dumps({"id": known, "status": status, "problem": problem.document})
    await websocket.send_text(reply.decode())
    seconds = time.perf_counter() - start
    record(services.metrics, websocket.scope, "LIVE", _PATH, status, seconds)


async def _plan(services: Services, body: PlanRequest, keep: bool, owner: str) -> bytes:
    if not keep:
        return await previewed(services, body, owner)
    answer = await answered(services, body, owner)
    if answer.cached:
        return await asyncio.to_thread(gzip.decompress, answer.content)
    return answer.content


def _parsed(content: str | bytes, limit: int) -> dict[str, Any]:
    if len(content) > limit:
        raise Problem(413, f"the message has more than {limit} bytes", kind="too-large")
    try:
        asked = orjson.loads(content)
    except ValueError as error:
        raise Problem(400, f"the message is not valid JSON: {error}", kind="bad-json") from None
    if not isinstance(asked, dict):
        raise Problem(422, "the message must be an object with id and body", kind="bad-input")
    return asked


def _question(asked: dict[str, Any]) -> LiveQuestion:
    try:
        return LiveQuestion.model_validate(asked)
    except ValidationError as error:
        raise from_validation(error.errors(), LiveQuestion) from None
