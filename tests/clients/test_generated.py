"""Clients that two generators make from the OpenAPI document work against a running server."""

from __future__ import annotations

import functools
import hashlib
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import httpx
import pytest
import trimesh

from tests.conftest import Server
from tests.test_installed import installer

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
PYTHON_LOCK = ROOT / "requirements-clients.lock"
NODE_FILES = [HERE / name for name in ("package.json", "package-lock.json", ".npmrc")]
STARTS = {"npz": b"PK\x03\x04", "mcap": b"\x89MCAP0"}
TSC = "--strict --skipLibCheck --target es2022 --module nodenext --types node"


def run(*command: str | Path, cwd: Path, **variables: str) -> str:
    """Output of a program that must succeed."""
    inherited = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    ended = subprocess.run(
        command, cwd=cwd, env=inherited | variables, capture_output=True, text=True, check=False
    )
    assert ended.returncode == 0, f"{command}\n{ended.stdout}\n{ended.stderr}"
    return ended.stdout


def kept(kind: str, *locks: Path) -> tuple[Path, bool]:
    """A folder for the tools that these locks name, and whether they are there already."""
    content = b"".join(lock.read_bytes() for lock in locks) + sys.version.encode()
    folder = ROOT / ".dev" / f"clients-{kind}-{hashlib.sha256(content).hexdigest()[:12]}"
    return folder, (folder / "complete").is_file()


@functools.cache
def python_tools() -> Path:
    """The folder of programs of an environment with openapi-python-client."""
    folder, complete = kept("python", PYTHON_LOCK)
    tools = folder / "bin"
    if not complete:
        shutil.rmtree(folder, ignore_errors=True)
        run(sys.executable, "-m", "venv", "--without-pip", folder, cwd=ROOT)
        installer(tools / "python")("--require-hashes", "-r", PYTHON_LOCK)
        (folder / "complete").touch()
    return tools


@functools.cache
def node_tools() -> Path:
    """A folder with the generator of TypeScript clients, the compiler and spectral."""
    if not all(map(shutil.which, ("node", "npm"))):
        pytest.fail("No Node here: run ./dev test.")
    folder, complete = kept("node", *NODE_FILES)
    if not complete:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        for file in NODE_FILES:
            shutil.copy(file, folder)
        run("npm", "ci", "--loglevel=error", cwd=folder)
        (folder / "complete").touch()
    return folder / "node_modules" / ".bin"


@pytest.fixture(scope="module")
def document(server: Server, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("openapi") / "openapi.json"
    path.write_bytes(httpx.get(f"{server.url}/api/v1/openapi.json").content)
    return path


@pytest.fixture(scope="module")
def mesh(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A block of 0.05 m after 1 m of level ground, as STL."""
    path = tmp_path_factory.mktemp("mesh") / "mesh.stl"
    ground = trimesh.creation.box(bounds=[(-1, -1, -0.1), (2, 1, 0.0)])
    block = trimesh.creation.box(bounds=[(0, -1, -0.1), (2, 1, 0.05)])
    trimesh.util.concatenate([ground, block]).export(path)
    return path


def check(told: dict[str, Any]) -> None:
    """What both clients must have got."""
    assert max(z for _, z in told["points"]) == pytest.approx(0.05)
    assert told["plan"].startswith("p-")
    assert told["rollout"].startswith("r-")
    samples, joint_samples, joints = told["samples"]
    assert samples == joint_samples > 100
    assert joints == 12
    csv, npz, mcap = (bytes.fromhex(start) for start in told["starts"])
    assert csv.decode().isprintable()
    assert npz.startswith(STARTS["npz"])
    assert mcap == STARTS["mcap"]
    assert told["refused"] == "urn:stairwright:problem:bad-input"


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_a_client_made_by_openapi_python_client(
    server: Server, document: Path, mesh: Path, tmp_path: Path
) -> None:
    tools = python_tools()
    options = ("--meta", "none", "--output-path", tmp_path / "made", "--fail-on-warning")
    path = f"{tools}{os.pathsep}{os.environ['PATH']}"  # it formats what it makes with ruff
    generator = tools / "openapi-python-client"
    run(generator, "generate", "--path", document, *options, cwd=tmp_path, PATH=path)
    shutil.copy(HERE / "python_client.py", tmp_path)
    told = run(tools / "python", "python_client.py", server.url, mesh, cwd=tmp_path)
    check(json.loads(told))


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_a_client_made_by_openapi_ts(
    server: Server, document: Path, mesh: Path, tmp_path: Path
) -> None:
    tools = node_tools()
    modules = tmp_path / "node_modules"
    modules.symlink_to(tools.parent)
    (tmp_path / "package.json").write_text('{"type": "module"}')
    output = {"path": "made", "importFileExtension": ".js"}
    chosen = json.dumps({"input": str(document), "output": output})
    (tmp_path / "openapi-ts.config.mjs").write_text(f"export default {chosen};\n")
    run(tools / "openapi-ts", "--silent", "--no-log-file", cwd=tmp_path)
    shutil.copy(HERE / "typescript_client.ts", tmp_path)
    run(tools / "tsc", *TSC.split(), "typescript_client.ts", cwd=tmp_path)
    check(json.loads(run("node", "typescript_client.js", server.url, mesh, cwd=tmp_path)))


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_spectral_has_nothing_to_say(document: Path, tmp_path: Path) -> None:
    tools, rules = node_tools(), tmp_path / "rules.yaml"
    rules.write_text('extends: ["spectral:oas"]\n')
    run(tools / "spectral", "lint", document, "-r", rules, "--fail-severity", "hint", cwd=tmp_path)
