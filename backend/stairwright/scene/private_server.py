"""A viser server that nobody but this process's user reaches: behind a Unix socket in a folder of
its own. On a port, viser would take any web page's WebSocket.

viser asks for a host and a port and hands them to `websockets.asyncio.server.serve`; while a server
is opened here, that call is given a socket of ours instead (viser's version is pinned, and a test
looks for ports that it would have opened).
"""

from __future__ import annotations

import shutil
import socket
import tempfile
import threading
from pathlib import Path
from typing import Any

import viser
import websockets.asyncio.server as library

_OPENING = threading.Lock()


class PrivateServer:
    """One viser server.

    Attributes:
        viser: The server.
        address: Its Unix socket.
    """

    def __init__(self, label: str) -> None:
        """Open it.

        Raises:
            OSError: If there is no room for its socket.
        """
        self._folder = Path(tempfile.mkdtemp(prefix="stairwright-"))  # for this user alone
        self.address = self._folder / "scene"
        try:
            self.viser = _open(label, self.address)
        except BaseException:
            shutil.rmtree(self._folder, ignore_errors=True)
            raise

    def close(self) -> None:
        """Stop the server."""
        self.viser.stop()
        shutil.rmtree(self._folder, ignore_errors=True)


def _open(label: str, address: Path) -> viser.ViserServer:
    # Bound here and not by viser, which would wait for ever for what cannot be bound.
    listener = socket.socket(socket.AF_UNIX)
    try:
        listener.bind(str(address))
        with _OPENING:
            original = library.serve

            def serve(handler: Any, _host: str, _port: int, **options: Any) -> Any:
                return original(handler, unix=True, sock=listener, **options)

            library.serve = serve  # type: ignore[assignment, misc]
            try:
                return viser.ViserServer(label=label, verbose=False)
            finally:
                library.serve = original  # type: ignore[misc]
    except BaseException:
        listener.close()
        raise
