"""Run the application with uvicorn."""

from __future__ import annotations

import socket

from stairwright.errors import InputError
from stairwright.jobs.launch import launch
from stairwright.kernel_cache import keep_kernels

from .settings import Settings


def serve(host: str | None = None, port: int | None = None) -> int:
    """Serve until interrupted; `host` and `port` win over the environment.

    Raises:
        InputError: If a setting is bad or the address cannot be had.
    """
    settings = Settings.from_env(host=host, port=port)
    _check_address(settings.host, settings.port)
    keep_kernels(settings.data / "kernels")
    launch()  # gets ready while this process imports what follows
    import uvicorn

    from . import logs
    from .app import create_app

    logs.configure(settings.log_level)
    uvicorn.run(
        create_app(settings),
        host=settings.host,
        port=settings.port,
        log_config=None,
        access_log=False,
        timeout_graceful_shutdown=3,
        ws="websockets-sansio",
        ws_per_message_deflate=False,
        server_header=False,
    )
    return 0


def _check_address(host: str, port: int) -> None:
    """Complain in one line before anything is started, not in a log after it."""
    try:
        for family, _, _, _, address in socket.getaddrinfo(host, port, type=socket.SOCK_STREAM):
            socket.create_server(address[:2], family=family).close()
    except (OSError, UnicodeError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"cannot serve on {host}: {reason}") from None
