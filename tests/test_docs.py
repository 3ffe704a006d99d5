"""The documents name files and functions that exist."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PLACES = ("backend", "native", "frontend/src", "benchmarks", "docs", "tests", "terrains", "robots")
NAMED = re.compile(r"`([\w./-]+\.(?:py|cpp|hpp|tsx?|md|yaml|lock))`")
DOCUMENTS = sorted([ROOT / "README.md", *(ROOT / "docs").glob("*.md")])


@pytest.fixture(scope="module")
def files() -> list[str]:
    inside = (path for place in PLACES for path in (ROOT / place).rglob("*") if path.is_file())
    return [f"/{path.relative_to(ROOT)}" for path in [*inside, *ROOT.iterdir()]]


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_named_files_exist(document: Path, files: list[str]) -> None:
    named = NAMED.findall(document.read_text())
    assert [name for name in named if not any(file.endswith(f"/{name}") for file in files)] == []


def test_equations_stand_where_the_method_says() -> None:
    rows = re.findall(r"^\| [\d, -]+ \|.*\|$", (ROOT / "docs/method.md").read_text(), re.MULTILINE)
    assert len(rows) > 15
    for row in rows:
        _, _, places, functions = row.strip("|").split("|")
        sources = [(ROOT / "backend/stairwright" / name) for name in NAMED.findall(places)]
        text = "".join(source.read_text() for source in sources)
        for name in re.findall(r"`(\w+)(?:\([^`]*)?`", functions):
            assert f"def {name}(" in text, row


@pytest.mark.parametrize("document", ["README.md", "docs/architecture.md"])
def test_layers_exist(document: str) -> None:
    (chain,) = re.findall(r"terrain`? (?:→|->) .*cli", (ROOT / document).read_text())
    for name in re.findall(r"[a-z]+", chain):
        inside = ROOT / "backend/stairwright" / name
        assert inside.is_dir() or inside.with_suffix(".py").is_file(), name
