"""How many wrong tokens one address may try."""

from __future__ import annotations

import hashlib
import ipaddress
import time
from collections.abc import Callable

WINDOW = 60.0  # s
_MOST_ADDRESSES = 4096


class Attempts:
    """Counts the different wrong secrets of each address within the last minute.

    The same wrong one again is no further guess: a page with an old cookie may keep asking.
    """

    def __init__(self, limit: int, clock: Callable[[], float] = time.monotonic) -> None:
        self._limit = limit
        self._clock = clock
        self._wrong: dict[str, dict[bytes, float]] = {}

    def wait(self, address: str) -> float:
        """Time until this address may try again [s]; 0 if it may now."""
        tried = self._recent(_network(address))
        if len(tried) < self._limit:
            return 0.0
        return sorted(tried.values())[-self._limit] + WINDOW - self._clock()

    def add_wrong(self, address: str, secret: str) -> None:
        """Remember a wrong secret, as a hash."""
        network = _network(address)
        tried = self._recent(network)
        digest = hashlib.sha256(secret.encode("utf-8", "replace")).digest()
        tried.setdefault(digest, self._clock())
        if network not in self._wrong and len(self._wrong) >= _MOST_ADDRESSES:
            del self._wrong[next(iter(self._wrong))]  # the one that came first
        self._wrong[network] = tried

    def _recent(self, network: str) -> dict[bytes, float]:
        before = self._clock() - WINDOW
        tried = self._wrong.pop(network, {})
        recent = {digest: at for digest, at in tried.items() if at > before}
        if recent:
            self._wrong[network] = recent
        return recent


def _network(address: str) -> str:
    """The address itself; of IPv6 the half that names a customer's network."""
    try:
        parsed = ipaddress.ip_address(address)
    except ValueError:
        return address
    if parsed.version == 4:
        return address
    return str(ipaddress.ip_network((parsed, 64), strict=False))
