"""Run programs with the checkout's own Python and Node, and tell of it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

from .places import ROOT, STATE, VENV

NODE_MINIMUM = (20, 19)  # what Vite asks for


class SetupError(Exception):
    """Something a person has to know or do; shown as one sentence."""


def say(text: str) -> None:
    """Tell what is going on, apart from the output of the programs that do it."""
    mark = "\x1b[1;36m▸\x1b[0m" if sys.stderr.isatty() else "▸"
    print(f"{mark} {text}", file=sys.stderr, flush=True)


def node_version() -> tuple[int, ...]:
    """The version of the machine's own Node, () if it or npm is missing."""
    if shutil.which("npm") is None or (node := shutil.which("node")) is None:
        return ()
    answer = subprocess.run([node, "--version"], check=False, capture_output=True, text=True)
    numbers = answer.stdout.strip().removeprefix("v").split(".")
    return tuple(int(n) for n in numbers) if all(n.isdigit() for n in numbers) else ()


def node_is_ours() -> bool:
    """Whether Node came from a Python package, because the machine has none or an old one."""
    return (STATE / "node-bin" / "npm").is_file() and node_version() < NODE_MINIMUM


def environment(extra: Mapping[str, str] | None = None) -> dict[str, str]:
    """The variables our programs run with: the checkout's own Python and Node come first."""
    # without bytecode each of the tests' servers and workers compiles all that it imports
    left_out = {"PYTHONHOME", "PYTHONPATH", "PYTHONDONTWRITEBYTECODE"}
    env = {k: v for k, v in os.environ.items() if k not in left_out}
    own = [str(VENV / "bin")] + ([str(STATE / "node-bin")] if node_is_ours() else [])
    env["PATH"] = os.pathsep.join([*own, env.get("PATH", os.defpath)])
    env["VIRTUAL_ENV"] = str(VENV)
    env |= {"PIP_DISABLE_PIP_VERSION_CHECK": "1", "npm_config_update_notifier": "false"}
    # what is said to pip holds for uv too
    for ours, theirs in (("UV_INDEX_URL", "PIP_INDEX_URL"), ("SSL_CERT_FILE", "PIP_CERT")):
        if theirs in env:
            env.setdefault(ours, env[theirs])
    return env | dict(extra or {})


def succeeds(*command: str | Path, cwd: Path = ROOT, env: Mapping[str, str] | None = None) -> bool:
    """Run a program with its output shown; True if it exits with 0."""
    try:
        return subprocess.run(command, cwd=cwd, env=environment(env), check=False).returncode == 0
    except FileNotFoundError:
        raise SetupError(f"{command[0]} is not installed.") from None


def run(*command: str | Path, cwd: Path = ROOT, env: Mapping[str, str] | None = None) -> None:
    """Run a program with its output shown; a failure ends everything."""
    if not succeeds(*command, cwd=cwd, env=env):
        shown = " ".join(str(part) for part in command)
        raise SetupError(f"This failed, and the lines above should say why:\n    {shown}")


def make_shim(path: Path, *command: str | Path) -> None:
    """A program that runs another with its own arguments behind."""
    quoted = " ".join(f'"{part}"' for part in command)
    path.write_text(f'#!/bin/sh\nexec {quoted} "$@"\n')
    path.chmod(0o755)
