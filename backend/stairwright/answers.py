"""What a service answers its client: a problem, the state of a job, or to come back later."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from email.utils import parsedate_to_datetime
from typing import TYPE_CHECKING, Any

import httpx

from stairwright.errors import StairwrightError

if TYPE_CHECKING:
    from stairwright.jobs.job import State

BUSY = (429, 503)
SHORTEST = 0.05  # s between two requests, whatever a service says


class ServiceError(StairwrightError):
    """The service said no: its problem document (RFC 9457)."""

    def __init__(self, problem: Mapping[str, Any]) -> None:
        super().__init__(str(problem.get("detail") or problem.get("title") or "unknown problem"))
        self.problem = dict(problem)

    @property
    def status(self) -> int:
        """The HTTP status."""
        return int(self.problem.get("status", 0))


@dataclass(frozen=True)
class JobState:
    """A job as the service told it last."""

    id: str
    state: State
    progress: float
    eta: float | None
    result: str | None
    error: Mapping[str, Any] | None

    @property
    def finished(self) -> bool:
        """Whether nothing will change any more."""
        return self.state in ("done", "failed", "cancelled")

    @classmethod
    def told(cls, data: Mapping[str, Any]) -> JobState:
        """From the service's document."""
        names = ("id", "state", "progress", "eta", "result", "error")
        return cls(**{name: data[name] for name in names})


def told_to_wait(response: httpx.Response) -> float | None:
    """How long until the same request makes sense again [s]; None if the answer does not say.

    RFC 9110, 10.2.3: Retry-After holds seconds or a date.
    """
    told = response.headers.get("retry-after", "").strip()
    if response.status_code not in BUSY or not told:
        return None
    if told.isascii() and told.isdigit():
        return max(SHORTEST, float(told))
    try:
        when = parsedate_to_datetime(told)
    except ValueError:
        return None
    when = when if when.tzinfo else when.replace(tzinfo=UTC)
    return max(SHORTEST, (when - datetime.now(UTC)).total_seconds())


def ask(send: Callable[[], httpx.Response], patience: float) -> httpx.Response:
    """The answer to a request, asked again as long as the service says when to come back.

    Args:
        send: Makes the request; must be harmless when repeated.
        patience: Gives up when coming back would be later than this after the first request [s].
    """
    give_up = time.monotonic() + patience
    while True:
        response = send()
        wait = told_to_wait(response)
        if wait is None or time.monotonic() + wait > give_up:
            return response
        time.sleep(wait)
