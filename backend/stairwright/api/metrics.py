"""Figures for Prometheus, one registry an application."""

from __future__ import annotations

from collections.abc import Callable

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, generate_latest

_SECONDS = (0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 30.0, 60.0)


class Metrics:
    """What the service counts."""

    def __init__(self) -> None:
        self.registry = CollectorRegistry()
        self._requests = Counter(
            "stairwright_requests",
            "Requests",
            ("method", "route", "status"),
            registry=self.registry,
        )
        self._seconds = Histogram(
            "stairwright_request_seconds",
            "Time to answer",
            ("route",),
            buckets=_SECONDS,
            registry=self.registry,
        )
        self.plans = Counter(
            "stairwright_plans", "Answered plan questions", ("cached",), registry=self.registry
        )

    def observe(self, method: str, route: str, status: int, seconds: float) -> None:
        """Count one request."""
        known = method if method in _METHODS else "other"
        self._requests.labels(known, route, status).inc()
        self._seconds.labels(route).observe(seconds)

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
