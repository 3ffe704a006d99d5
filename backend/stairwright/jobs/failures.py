"""Why work was not done, when neither the input nor the code is to blame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from http import HTTPStatus
from typing import Any

from stairwright.errors import Cancelled, InputError, StairwrightError


class Failure(StairwrightError):
    """Base: `status` is the HTTP status that fits, `retry_after` seconds make sense if given."""

    status = 503
    kind = "failed"

    def __init__(self, message: str, retry_after: float | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.retry_after = retry_after


class QueueFull(Failure):
    """Too much is waiting already."""

    status = 429
    kind = "queue-full"


class DeadlineExceeded(Failure):
    """The work took longer than it may."""

    kind = "deadline"


class WorkerDied(Failure):
    """The process that did the work is gone: killed, out of memory, or crashed."""

    kind = "worker-died"


class GivenUp(WorkerDied):
    """Workers have died at it again and again: not once more."""


class Unreachable(Failure):
    """The cluster that was to do the work cannot be reached, or has no workers."""

    kind = "unreachable"


class OutOfMemory(Failure, MemoryError):
    """The work wants more memory than a worker may have: asking again does not help."""

    status = 422
    kind = "memory"

    def __init__(self, limit: int = 0) -> None:
        allowed = f" ({limit} MiB)" if limit else ""
        super().__init__(
            f"this takes more memory than a worker may have{allowed}: ask for less, for instance "
            "a terrain of fewer points, or raise STAIRWRIGHT_WORKER_MEMORY"
        )


class Interrupted(Failure):
    """The service ended while it was at the work, and cannot go on with it."""

    kind = "interrupted"


LOST = frozenset(
    {WorkerDied.kind, Interrupted.kind, Unreachable.kind}
)  # no fault of the question's: ask again


def is_lost(error: Mapping[str, Any] | None) -> bool:
    """Whether a problem document says that the service lost the work."""
    return error is not None and str(error.get("type", "")).rpartition(":")[2] in LOST


def problem_of(error: BaseException) -> dict[str, Any]:
    """A failed job's problem document (RFC 9457)."""
    errors: list[dict[str, str]] = []
    status, kind, detail = 500, "bug", "the work failed unexpectedly; see the log"
    if isinstance(error, InputError):
        status, kind, detail = 422, "bad-input", str(error)
        errors = [{"field": error.path, "message": error.message}]
    elif isinstance(error, Failure):
        status, kind, detail = error.status, error.kind, error.message
    elif isinstance(error, Cancelled):
        status, kind, detail = 409, "cancelled", "the job was cancelled"
    return problem(status, kind, detail, errors)


def problem(
    status: int, kind: str, detail: str, errors: Sequence[Mapping[str, str]] = ()
) -> dict[str, Any]:
    """A problem document as plain data; without a kind it says no more than its status."""
    return {
        "type": f"urn:stairwright:problem:{kind}" if kind else "about:blank",
        "title": HTTPStatus(status).phrase,
        "status": status,
        "detail": detail,
        "errors": [dict(error) for error in errors],
    }
