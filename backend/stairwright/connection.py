"""A connection to a running service: its requests, repeated while it is busy, and its jobs."""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable, Mapping
from functools import partial
from types import TracebackType
from typing import Any, Self
from urllib.parse import quote

import httpx

from stairwright.answers import JobState, ServiceError, ask

Progress = Callable[[float], object]
PREFIX = "/api/v1"


class Connection:
    """Talks to one service. Methods raise `ServiceError` for an answer that says no.

    Args:
        url: Of the service, without a path.
        token: Where it asks for one.
        timeout: Of one request [s].
        patience: How long a request is repeated that finds the service busy [s]; 0 for not at all.
    """

    def __init__(
        self, url: str, token: str | None = None, timeout: float = 120.0, patience: float = 60.0
    ) -> None:
        headers = {"authorization": f"Bearer {token}"} if token else {}
        self._http = httpx.Client(base_url=url, headers=headers, timeout=timeout)
        self._patience = patience

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the connections."""
        self._http.close()

    def job(self, job_id: str) -> JobState:
        """A job's state."""
        return JobState.told(self._json("GET", f"/jobs/{quoted(job_id)}"))

    def cancel(self, job_id: str) -> JobState:
        """Cancel a job."""
        return JobState.told(self._json("DELETE", f"/jobs/{quoted(job_id)}"))

    def wait(
        self, job_id: str, *, progress: Progress | None = None, timeout: float = 900.0
    ) -> JobState:
        """Follow a job to its end.

        Raises:
            TimeoutError: After `timeout` [s]; the job is cancelled then.
        """
        give_up, pause = time.monotonic() + timeout, 0.02
        while True:
            job = self.job(job_id)
            if progress is not None:
                progress(job.progress)
            if job.finished:
                return job
            if time.monotonic() > give_up:
                self.cancel(job_id)
                raise TimeoutError(f"the job took longer than {timeout:g} s")
            time.sleep(pause)
            pause = min(1.0, 1.3 * pause)

    def _start(self, path: str, body: Mapping[str, Any]) -> JobState:
        headers = {"idempotency-key": secrets.token_hex(16)}
        for attempt in (1, 2, 3):
            try:
                return JobState.told(self._json("POST", path, json=body, headers=headers))
            except httpx.TransportError:
                if attempt == 3:
                    raise
                time.sleep(0.2 * attempt)
        raise AssertionError("unreachable")

    def _export(self, kind: str, name: str, file_format: str, rate: float | None = None) -> bytes:
        path = f"/{kind}/{quoted(name)}/export"
        params = {"format": file_format} | ({} if rate is None else {"rate": str(rate)})
        return self._send("GET", path, params=params).content

    def _json(self, method: str, path: str, **options: Any) -> Any:
        return self._send(method, path, **options).json()

    def _send(self, method: str, path: str, **options: Any) -> httpx.Response:
        # Repeating is harmless: a plan is the same plan, a rollout has its idempotency key.
        request = partial(self._http.request, method, PREFIX + path, **options)
        response = ask(request, self._patience)
        if response.is_error:
            try:
                problem = response.json()
            except ValueError:
                problem = {"detail": response.text[:200], "status": response.status_code}
            raise ServiceError(problem)
        return response


def quoted(name: str) -> str:
    """A name as a part of a path."""
    return quote(name, safe="")
