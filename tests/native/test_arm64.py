"""Robots' computers are 64-bit ARM: core, Python module, example and player compile for them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
AARCH64 = 183  # ELF's number


@pytest.mark.slow
@pytest.mark.timeout(900)
@pytest.mark.skipif(
    not (ROOT / ".dev" / "zig-bin" / "arm64-c++").is_file(),
    reason="the compiler is not set up: ./dev arm64 does that, and takes minutes the first time",
)
def test_the_core_compiles_for_arm64() -> None:
    done = subprocess.run(
        [sys.executable, ROOT / "dev", "arm64"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr[-3000:]
    made = [*(ROOT / ".dev" / "arm64").glob("_core.*-aarch64-linux-gnu.so")]
    made += [ROOT / ".dev" / "arm64" / name for name in ("control_steps", "stairwright_player")]
    assert len(made) == 3
    for path in made:
        head = path.read_bytes()[:20]
        assert head[:4] == b"\x7fELF"
        assert int.from_bytes(head[18:20], "little") == AARCH64
