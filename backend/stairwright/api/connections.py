"""Bounds on connections, which uvicorn leaves to a proxy: how long, how large, how many.

A request must arrive in time, its head within 64 KiB, and one address has only so many connections.
Where they run out, one that sends nothing makes room for the next: whoever holds connections open
without asking keeps nobody out.
"""

from __future__ import annotations

import asyncio
import ipaddress
import math
from dataclasses import dataclass
from typing import Any, ClassVar

from uvicorn.protocols.http.httptools_impl import STATUS_LINE, HttpToolsProtocol

from .addresses import Network
from .problems import Problem

HEAD_LIMIT = 64 * 1024  # bytes of a request's line and headers
SLOWEST = 1000.0  # bytes/s; a body that comes faster than this may take as long as it needs


@dataclass(frozen=True, kw_only=True)
class Bounds:
    """What connections may take.

    Attributes:
        patience: Time for a request's head, and for a body that hardly moves [s].
        per_address: Connections of one address.
        total: Connections of all addresses.
        proxies: Addresses that speak for many clients, so that only `total` holds for them.
    """

    patience: float
    per_address: int
    total: int
    proxies: tuple[Network, ...] = ()

    def crowd(self, host: str | None, others: list[Any]) -> list[Any]:
        """The open connections that leave no room for one more of `host`; empty if there is."""
        if len(others) >= self.total:
            return others
        if host is None or self._is_proxy(host):
            return []
        same = [other for other in others if other.client and other.client[0] == host]
        return same if len(same) >= self.per_address else []

    def _is_proxy(self, host: str) -> bool:
        if not self.proxies:
            return False
        address = ipaddress.ip_address(host)
        return any(address in network for network in self.proxies)


class BoundedProtocol(HttpToolsProtocol):
    """Uvicorn's protocol within `bounds`, which `bounded` sets."""

    bounds: ClassVar[Bounds]
    _arriving: bool
    _in_body: bool

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Make room for the connection, or say that there is none."""
        super().connection_made(transport)
        self._overdue: asyncio.TimerHandle | None = None
        self._expect()
        others = [
            other
            for other in self.connections
            if other is not self and not other.transport.is_closing()
        ]
        crowd = self.bounds.crowd(self.client[0] if self.client else None, others)
        if not crowd:
            return
        silent = [other for other in crowd if isinstance(other, BoundedProtocol) and other.silent]
        if silent:
            min(silent, key=lambda other: other.claim).transport.close()
        else:
            detail = "there are too many connections"
            headers = {"retry-after": str(math.ceil(self.bounds.patience))}
            self._give_up(Problem(429, detail, kind="connections", headers=headers))

    @property
    def silent(self) -> bool:
        """Whether nothing that was asked completely is being answered."""
        return self._arriving or self.cycle is None or self.cycle.response_complete

    @property
    def claim(self) -> tuple[bool, float]:
        """What a silent connection's claim to stay is worth: least if it has waited for longest."""
        return self._in_body, self._since

    def connection_lost(self, exc: Exception | None) -> None:
        """No request is expected any more."""
        self._expect_none()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Count what arrives."""
        self._received += len(data)
        super().data_received(data)
        if self._arriving and not self._in_body and self._received > HEAD_LIMIT:
            detail = f"the request's head has more than {HEAD_LIMIT} bytes"
            self._give_up(Problem(431, detail, kind="too-large"))

    def on_message_begin(self) -> None:
        """The first byte of a request."""
        super().on_message_begin()
        if not self._arriving:
            self._expect()
            self._received = 1  # at least; it came together with the request before

    def on_headers_complete(self) -> None:
        """The head is there."""
        super().on_headers_complete()
        self._in_body = True

    def on_message_complete(self) -> None:
        """The whole request is there."""
        super().on_message_complete()
        self._expect_none()

    def handle_websocket_upgrade(self) -> None:
        """From here on the connection belongs to the WebSocket's protocol."""
        self._expect_none()
        super().handle_websocket_upgrade()

    def _expect(self) -> None:
        """A request has to arrive from now on."""
        self._since = self.loop.time()
        self._received = 0
        self._arriving, self._in_body = True, False
        self._overdue = self.loop.call_later(self.bounds.patience, self._look)

    def _expect_none(self) -> None:
        self._since = self.loop.time()
        self._arriving = False
        if self._overdue is not None:
            self._overdue.cancel()
            self._overdue = None

    def _look(self) -> None:
        """Give the request up if it is overdue, or look again when it will be."""
        patience = self.bounds.patience
        if self._in_body and self.flow.read_paused:
            self._since += patience  # it is us who do not read
        more = self._received / SLOWEST if self._in_body else 0.0
        left = self._since + patience + more - self.loop.time()
        if left > 0.0:
            self._overdue = self.loop.call_later(left, self._look)
        elif self._received:
            self._give_up(Problem(408, "the request did not arrive in time", kind="overdue"))
        else:
            self.transport.close()

    def _give_up(self, problem: Problem) -> None:
        """Answer, unless another answer is on its way or has been given, and close."""
        cycle = self.cycle
        if self._in_body:
            free = not cycle.response_started
        else:
            free = cycle is None or cycle.response_complete
        self._expect_none()
        if free and not self.transport.is_closing():
            answer = problem.response()
            lines = [name + b": " + value for name, value in answer.raw_headers]
            head = STATUS_LINE[problem.status] + b"\r\n".join(lines)
            self.transport.write(head + b"\r\nconnection: close\r\n\r\n" + bytes(answer.body))
        self.transport.close()


def bounded(bounds: Bounds) -> type[BoundedProtocol]:
    """The protocol with these bounds, for uvicorn, which makes one for each connection."""
    return type("Protocol", (BoundedProtocol,), {"bounds": bounds})
