"""`./dev bench --quick` comes to its end."""

from __future__ import annotations

import ast
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).resolve().parents[1] / "benchmarks"


def names() -> list[str]:
    """What `./dev bench` runs: the keys of TITLES."""
    for node in ast.parse((BENCHMARKS / "run.py").read_text()).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "TITLES":
            return list(ast.literal_eval(node.value))
    raise AssertionError("run.py has no TITLES")


@pytest.mark.slow
@pytest.mark.parametrize("name", names())
def test_every_benchmark_has_a_quick_form(name: str) -> None:
    told = subprocess.run(
        [sys.executable, BENCHMARKS / f"{name}.py", "--help"], capture_output=True, text=True
    )
    assert "--quick" in told.stdout, told.stderr


@pytest.mark.browser
def test_the_dragging_benchmark_in_its_quick_form(browser_path: str, tmp_path: Path) -> None:
    command = [sys.executable, BENCHMARKS / "run.py", "drag", "--quick", "--keep", tmp_path]
    variables = os.environ | {"STAIRWRIGHT_BROWSER": browser_path}
    ended = subprocess.run(command, env=variables, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    rows = json.loads((tmp_path / "drag.json").read_text())["rows"]
    shown = {row["work"]: row["median"] for row in rows}
    assert shown["move to poses, single-stair-036"] > 0.0
