"""Run the application with uvicorn."""

from __future__ import annotations

import gc
import socket

from stairwright.errors import InputError
from stairwright.jobs.launch import launch

from .settings import Settings

_MOST_DESCRIPTORS = 65536


def serve(host: str | None = None, port: int | None = None) -> int:
    """Serve until interrupted; `host` and `port` win over the environment.

    Raises:
        InputError: If a setting is bad or the address cannot be had.
    """
    settings = Settings.from_env(host=host, port=port)
    _check_address(settings.host, settings.port)
    descriptors = _raise_descriptor_limit()
    launch()  # gets ready while this process imports what follows
    gc.disable()  # all of which stays: to look for garbage in it is a tenth of a start
    import uvicorn

    from . import logs
    from .app import create_app
    from .connections import Bounds, bounded

    logs.configure(settings.log_level)
    bounds = Bounds(
        patience=settings.receive_timeout,
        per_address=settings.connections,
        total=descriptors // 2,  # the other half is for files, workers and scenes
        proxies=settings.trusted_proxies,
    )
    app = create_app(settings)
    gc.freeze()
    gc.enable()
    uvicorn.run(
        app,
        host=settings.host,
        port=settings.port,
        http=bounded(bounds),
        log_config=None,
        access_log=False,
        timeout_keep_alive=settings.keep_alive,
        timeout_graceful_shutdown=3,
        proxy_headers=bool(settings.trusted_proxies),
        forwarded_allow_ips=[str(network) for network in settings.trusted_proxies],
        ws="websockets-sansio",
        ws_per_message_deflate=False,
        server_header=False,
    )
    return 0


def _raise_descriptor_limit() -> int:
    """Take as many file descriptors as the system grants, 65,536 at most; how many there are."""
    try:
        import resource
    except ImportError:  # Windows, which has no such limit
        return _MOST_DESCRIPTORS
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = _MOST_DESCRIPTORS if hard == resource.RLIM_INFINITY else min(hard, _MOST_DESCRIPTORS)
    if soft != resource.RLIM_INFINITY and soft < wanted:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))
    return wanted


def _check_address(host: str, port: int) -> None:
    """Complain in one line before anything is started, not in a log after it."""
    try:
        for family, _, _, _, address in socket.getaddrinfo(host, port, type=socket.SOCK_STREAM):
            socket.create_server(address[:2], family=family).close()
    except (OSError, UnicodeError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"cannot serve on {host}: {reason}") from None
