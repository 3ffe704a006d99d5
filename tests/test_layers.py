"""Imports only ever point left, as docs/architecture.md draws them."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

PACKAGE = Path(__file__).parents[1] / "backend" / "stairwright"
LAYERS = (
    "terrain", "robot", "planning", "control", "simulation", "export", "scene", "storage", "jobs",
    "studies", "api",
)  # fmt: skip


def at_import(node: ast.AST) -> Iterator[ast.Import | ast.ImportFrom]:
    """Imports that run when the module is loaded."""
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
        return
    if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test):
        return
    if isinstance(node, ast.Import | ast.ImportFrom):
        yield node
    for child in ast.iter_child_nodes(node):
        yield from at_import(child)


def imported(node: ast.Import | ast.ImportFrom, package: tuple[str, ...]) -> list[str]:
    """Full names of the modules that a statement in `package` names."""
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    base = package[: len(package) - node.level + 1] if node.level else ()
    start = ".".join((*base, *((node.module,) if node.module else ())))
    return [f"{start}.{alias.name}" for alias in node.names]


def test_imports_point_left() -> None:
    wrong, seen = [], 0
    for file in sorted(PACKAGE.rglob("*.py")):
        parts = file.relative_to(PACKAGE).parts
        if parts[0] not in LAYERS:
            continue
        for node in at_import(ast.parse(file.read_text())):
            for name in imported(node, ("stairwright", *parts[:-1])):
                top, _, rest = name.partition(".")
                layer = rest.partition(".")[0]
                if top != "stairwright" or layer not in LAYERS:
                    continue
                seen += 1
                if LAYERS.index(layer) > LAYERS.index(parts[0]):
                    wrong.append(f"{'/'.join(parts)}:{node.lineno} imports {name}")
    assert wrong == []
    assert seen > 500


def test_the_certificate_shares_no_native_code_with_the_planner() -> None:
    native = PACKAGE.parents[1] / "native"
    included = {
        line.split('"')[1]
        for folder in ("src", "include/stairwright")
        for file in (native / folder / "certificate").iterdir()
        for line in file.read_text().splitlines()
        if line.startswith('#include "')
    }
    own = {name for name in included if name.startswith("stairwright/certificate/")}
    assert own
    assert included - own == {"stairwright/vec2.hpp", "sparing.hpp"}
