"""Where things are in a checkout."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
VENV = ROOT / ".venv"
STATE = ROOT / ".dev"  # stamps and a Node of our own, where the machine has none
FRONTEND = ROOT / "frontend"
BACKEND = ROOT / "backend" / "stairwright"
NATIVE = ROOT / "native"
PYTHON = VENV / "bin" / "python"
# serving; beside that, studies; beside both, testing
LOCKS = tuple(ROOT / f"requirements{name}.lock" for name in ("", "-studies", "-dev"))
UV_LOCK = ROOT / "requirements-uv.lock"
NODE_LOCK = ROOT / "requirements-node.lock"
ZIG_LOCK = ROOT / "requirements-zig.lock"
CLIENTS_LOCK = ROOT / "requirements-clients.lock"
BENCH_LOCK = ROOT / "requirements-bench.lock"
