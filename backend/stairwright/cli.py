"""The command `stairwright`. Heavy imports wait until a command needs them."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from .errors import InputError


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; the exit status is 0 (done), 1 (it cannot be done) or 2 (bad input)."""
    parser = argparse.ArgumentParser(prog="stairwright")
    commands = parser.add_subparsers(dest="command", required=True)
    serve = commands.add_parser("serve", help="serve the page, REST and the 3D scene")
    serve.add_argument("--host")
    serve.add_argument("--port", type=int)
    chosen = parser.parse_args(arguments)
    try:
        from .api.server import serve as run

        return run(host=chosen.host, port=chosen.port)
    except InputError as error:
        print(f"stairwright: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
