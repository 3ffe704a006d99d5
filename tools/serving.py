"""Serve the product."""

from __future__ import annotations

import os
import shlex
import socket
import sys
from collections.abc import Sequence
from typing import NoReturn

from .building import setup, studies
from .places import LOCKS, PYTHON, ROOT
from .running import SetupError, environment, say


def up(arguments: Sequence[str]) -> NoReturn:
    """Serve the product until Ctrl-C."""
    import argparse

    parser = argparse.ArgumentParser(prog="./dev up", description="Set up and serve Stairwright.")
    parser.add_argument("--host", default="127.0.0.1", help="address to serve on (%(default)s)")
    port = os.environ.get("PORT", "8000")
    parser.add_argument("--port", type=int, default=port, help="port, also PORT (%(default)s)")
    chosen = parser.parse_args(arguments)
    family = socket.AF_INET6 if ":" in chosen.host else socket.AF_INET
    with socket.socket(family) as probe:  # say so now, not after minutes of set-up
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((chosen.host, chosen.port))
        except (OSError, OverflowError) as error:
            raise SetupError(
                f"Cannot serve on {chosen.host} port {chosen.port}: {error}. "
                "Another one: ./dev up --port 8001"
            ) from None
    setup(LOCKS[:1])
    if os.environ.get("STAIRWRIGHT_SCHEDULER"):  # then rollouts need Dask, too
        studies()
    local = {"127.0.0.1", "0.0.0.0", "::1", "::"}  # noqa: S104 (compared with, not bound to)
    shown = "localhost" if chosen.host in local else chosen.host
    say(f"Stairwright: http://{shown}:{chosen.port}   (Ctrl-C ends it)")
    serve = ("serve", "--host", chosen.host, "--port", str(chosen.port))
    command = [str(PYTHON), "-m", "stairwright", *serve]
    on_demand = {
        "STAIRWRIGHT_STUDIES_SETUP": shlex.join([sys.executable, str(ROOT / "dev"), "studies"])
    }
    os.execve(PYTHON, command, environment(on_demand))  # noqa: S606 (our own Python)
