"""Which versions of Python's packages there are to be."""

from __future__ import annotations

import re
from pathlib import Path

from .packages import setup_uv
from .places import BENCH_LOCK, CLIENTS_LOCK, LOCKS, NODE_LOCK, STATE, UV_LOCK, ZIG_LOCK
from .running import run


def lock_blocks(path: Path) -> list[str]:
    """The entries of a lock, each with its hashes."""
    return re.findall(r"^\S.*\n(?:\s+.*\n)*", path.read_text(), flags=re.MULTILINE)


def blocks_beyond(path: Path, *others: Path) -> list[str]:
    """The entries of a lock for packages that the other locks do not name."""
    named = {block.partition("==")[0] for other in others for block in lock_blocks(other)}
    return [block for block in lock_blocks(path) if block.partition("==")[0] not in named]


def lock() -> int:
    """Choose the newest versions that pyproject.toml allows and write them down with hashes."""
    uv = setup_uv()
    STATE.mkdir(exist_ok=True)
    style = "--generate-hashes --no-emit-index-url --no-header --no-annotate --quiet --upgrade"
    style += " --fork-strategy fewest"
    compile_ = (uv, "pip", "compile", *style.split(), "--universal", "--python-version", "3.11")
    everything = STATE / "everything.lock"
    run(*compile_, "pyproject.toml", "--group", "build", "-o", LOCKS[0])
    for number, extras in ((1, ("--extra", "studies")), (2, ("--all-extras", "--group", "dev"))):
        smaller = LOCKS[:number]
        constraints = [word for path in smaller for word in ("-c", path)]
        run(*compile_, "pyproject.toml", *extras, *constraints, "-o", everything)
        LOCKS[number].write_text("".join(blocks_beyond(everything, *smaller)))
    alone = {"node": NODE_LOCK, "uv": UV_LOCK, "zig": ZIG_LOCK, "clients": CLIENTS_LOCK}
    for group, path in alone.items():
        run(*compile_, "--group", group, "-o", path)
    constraints = [word for path in LOCKS for word in ("-c", path)]
    run(*compile_, "--group", "bench", *constraints, "-o", everything)
    BENCH_LOCK.write_text("".join(blocks_beyond(everything, *LOCKS)))
    return 0
