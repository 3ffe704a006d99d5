"""How to reach a Dask scheduler that runs elsewhere."""

from __future__ import annotations

import socket
from typing import Any

from .worker import CorePlugin

CONNECT_LIMIT = 20.0  # s
KNOCK_LIMIT = 5.0  # s


def knock(address: str) -> None:
    """Ask whether anybody listens: Dask itself would wait for somebody.

    Raises:
        OSError: If nobody does.
        ValueError: If that is no address.
    """
    from distributed.comm import get_address_host_port

    host, port = get_address_host_port(address)
    socket.create_connection((host, port), timeout=KNOCK_LIMIT).close()


def configured_security() -> Any:
    """TLS as Dask's own configuration says (DASK_DISTRIBUTED__COMM__TLS__...); None without."""
    from distributed import Security

    made = Security()
    return made if made.require_encryption or made.tls_ca_file else None


def dask_plugin() -> Any:
    """The plugin that loads the core on every worker, as Dask wants it."""
    from distributed import WorkerPlugin

    kind: Any = type("StairwrightCore", (CorePlugin, WorkerPlugin), {})
    return kind()
