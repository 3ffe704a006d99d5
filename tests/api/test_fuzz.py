"""Five hundred damaged requests of the fuzzer; the long run is `benchmarks/fuzz.py`."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import Server

FUZZER = Path(__file__).resolve().parents[2] / "benchmarks" / "fuzz.py"


@pytest.mark.slow
def test_no_damaged_request_breaks_the_service(server: Server) -> None:
    ended = subprocess.run(
        [sys.executable, FUZZER, "--count", "500", "--url", server.url],
        check=False, capture_output=True, text=True,
    )  # fmt: skip
    assert ended.returncode == 0, ended.stderr
    assert "0 of 500 are 5xx" in ended.stdout
