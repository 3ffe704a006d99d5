"""Locks of packages: hashes, no addresses, and all that is asked for."""

from __future__ import annotations

import importlib.metadata
import re
import subprocess
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tools import locks

ROOT = Path(__file__).resolve().parents[1]
LOCKS = [ROOT / f"requirements{name}.lock" for name in ("", "-studies", "-dev")]
ALL_LOCKS = [*LOCKS, *(ROOT / f"requirements-{name}.lock" for name in ("node", "bench", "clients"))]
# put together here, so that this file does not contain what it looks for
REGISTRY_HOSTS = [
    "pypi" + ".org",
    "files.python" + "hosted.org",
    "registry.npm" + "js.org",
    "registry.yarn" + "pkg.com",
    "deb.deb" + "ian.org",
    "docker" + ".io/",
]


def locked(path: Path) -> dict[str, str]:
    """Package names and versions in a lock."""
    return {
        canonicalize_name(name): version
        for name, version in re.findall(r"^([\w.-]+)==([^\s;]+)", path.read_text(), re.MULTILINE)
    }


@pytest.mark.parametrize("path", ALL_LOCKS, ids=lambda path: path.name)
def test_every_locked_package_has_hashes_and_no_address(path: Path) -> None:
    blocks = locks.lock_blocks(path)
    assert "".join(blocks) == path.read_text()
    for block in blocks:
        assert re.match(r"[\w.-]+==[\w.]+", block), block
        assert "--hash=sha256:" in block
    assert "://" not in path.read_text()
    assert "index" not in re.findall(r"^\s*--(\w+)", path.read_text(), re.MULTILINE)


def test_locks_satisfy_what_the_package_asks_for() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    dev_group = [r for r in project["dependency-groups"]["dev"] if isinstance(r, str)]
    asked = (
        project["project"]["dependencies"] + project["dependency-groups"]["build"],
        project["project"]["optional-dependencies"]["studies"],
        dev_group,
    )
    there: dict[str, str] = {}
    for lock, texts in zip(LOCKS, asked, strict=True):
        assert not there.keys() & locked(lock).keys()
        there |= locked(lock)
        for text in texts:
            requirement = Requirement(text)
            assert requirement.specifier.contains(there[canonicalize_name(requirement.name)]), text


def test_what_studies_need_is_in_their_lock() -> None:
    """Else `./dev up` would carry it for everybody, or maps would lack it."""
    serving, with_studies = locked(LOCKS[0]), locked(LOCKS[0]) | locked(LOCKS[1])
    extra = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    todo = [Requirement(text).name for text in extra["studies"]]
    seen: set[str] = set()
    while todo:
        name = canonicalize_name(todo.pop())
        if name in seen:
            continue
        seen.add(name)
        assert name in with_studies, f"{name} is not locked"
        for text in importlib.metadata.requires(name) or ():
            requirement = Requirement(text)
            if requirement.marker is None or requirement.marker.evaluate({"extra": ""}):
                todo.append(requirement.name)
    assert len(seen - serving.keys()) > 20


def test_what_is_installed_is_what_is_locked() -> None:
    versions = {name: version for lock in LOCKS for name, version in locked(lock).items()}
    for name in ("numpy", "mujoco", "viser", "casadi", "fastapi", "xarray", "pytest"):
        assert importlib.metadata.version(name) == versions[name]


def test_no_tracked_file_names_a_registry_host() -> None:
    listing = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert listing.returncode == 0, listing.stderr
    files = [ROOT / name for name in listing.stdout.split("\0") if name]
    assert len(files) > 20
    named = [
        f"{path.relative_to(ROOT)}: {host}"
        for path in files
        if path.is_file()
        for host in REGISTRY_HOSTS
        if host.encode() in path.read_bytes()
    ]
    assert not named
