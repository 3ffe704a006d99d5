"""Figures for Prometheus, one registry an application."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from prometheus_client import (
    CollectorRegistry,
    Counter,
    Gauge,
    Histogram,
    ProcessCollector,
    generate_latest,
)

from stairwright.storage.documents import Entry

_SECONDS = (0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0, 60.0)
_LONG = (*_SECONDS, 120.0, 300.0, 900.0)


class Metrics:
    """What the service counts."""

    def __init__(self) -> None:
        self.registry = CollectorRegistry()
        counter = partial(Counter, namespace="stairwright", registry=self.registry)
        times = partial(Histogram, namespace="stairwright", registry=self.registry)
        answering, working = "Time to answer", "Time that a worker was at a task"
        self._requests = counter("requests", "Requests", ("method", "route", "status"))
        self._seconds = times("request_seconds", answering, ("route",), buckets=_SECONDS)
        self.plans = counter("plans", "Answered plan questions", ("cached",))
        self._work_seconds = times("work_seconds", working, ("pool",), buckets=_LONG)
        self._waiting_seconds = times(
            "waiting_seconds", "Time that a task waited for its turn", ("queue",), buckets=_LONG
        )
        done = "Tasks by what became of them: done, or the kind of the problem"
        self._work = counter("work", done, ("pool", "outcome"))
        said = "New results by what they say: a plan's status, a rollout's outcome"
        self._outcomes = counter("outcomes", said, ("kind", "outcome"))
        ProcessCollector(registry=self.registry)

    def observe(self, method: str, route: str, status: int, seconds: float) -> None:
        """Count one request."""
        known = method if method in _METHODS else "other"
        self._requests.labels(known, route, status).inc()
        self._seconds.labels(route).observe(seconds)

    def worked(self, pool: str, seconds: float, outcome: str) -> None:
        """Count a task that a worker was at."""
        self._work_seconds.labels(pool).observe(seconds)
        self._work.labels(pool, outcome).inc()

    def waited(self, queue: str, seconds: float) -> None:
        """Count a task that has got its turn."""
        self._waiting_seconds.labels(queue).observe(seconds)

    def resulted(self, result: Entry) -> None:
        """Count a new result."""
        outcome = result.summary.get("outcome") or result.summary.get("status")
        self._outcomes.labels(result.kind, str(outcome)).inc()

    def gauge(self, name: str, text: str, value: Callable[[], float], **labels: str) -> None:
        """Show a value that is read when asked for."""
        gauge = Gauge(f"stairwright_{name}", text, tuple(labels), registry=None)
        child = gauge.labels(**labels) if labels else gauge
        child.set_function(value)
        self.registry.register(gauge)

    def text(self) -> bytes:
        """The exposition format."""
        return generate_latest(self.registry)


_METHODS = frozenset({"GET", "HEAD", "POST", "PUT", "DELETE", "OPTIONS", "PATCH", "LIVE"})
