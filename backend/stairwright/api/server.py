"""Run the application with uvicorn."""

from __future__ import annotations

from stairwright.jobs.launch import launch

from .settings import Settings


def serve(host: str | None = None, port: int | None = None) -> int:
    """Serve until interrupted; `host` and `port` win over the environment."""
    settings = Settings.from_env(host=host, port=port)
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
        ws_per_message_deflate=False,
        server_header=False,
    )
    return 0
