"""What a machine has to have: system packages, shared libraries, a browser."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
import sys
from pathlib import Path

from .running import SetupError, say, succeeds

BROWSERS = (
    "chromium-headless-shell",  # the same without windows, which take a good tenth of its time
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
)
MAC_BROWSER = Path("/Applications/Google Chrome.app/Contents/MacOS/Google Chrome")


def apt_install(*packages: str, purpose: str) -> None:
    """Install Debian packages, or say which ones are missing and for what."""
    ask = f"{purpose} Please install it, for example: apt-get install {' '.join(packages)}"
    apt = shutil.which("apt-get")
    if apt is None:
        raise SetupError(ask)
    prefix: list[str] = []
    if os.geteuid() != 0:
        sudo = shutil.which("sudo")
        may = [sudo, "-n", "true"] if sudo else ["false"]
        if subprocess.run(may, check=False, capture_output=True).returncode != 0:
            raise SetupError(ask)
        prefix = [str(sudo), "-n"]
    apt_get = [*prefix, "env", "DEBIAN_FRONTEND=noninteractive", apt, "-q", "-y"]
    say(f"{purpose} Installing {' and '.join(packages)} from the system's packages ...")
    # an old package list names files that are gone, an empty one names nothing: renew it first
    updated = succeeds(*apt_get, "update")
    if not (succeeds(*apt_get, "install", "--no-install-recommends", *packages) or updated):
        raise SetupError(f"The system's package lists cannot be reached. {ask}")


def setup_library(library: str, package: str, purpose: str) -> None:
    """A shared library that some Python package expects the system to have."""
    if sys.platform == "linux":
        try:
            ctypes.CDLL(library)
        except OSError:
            apt_install(package, purpose=purpose)


def find_browser() -> str | None:
    """A Chromium or Chrome on this machine."""
    named = os.environ.get("STAIRWRIGHT_BROWSER")
    if named and not shutil.which(named):
        raise SetupError(f"STAIRWRIGHT_BROWSER names {named}, which cannot be run.")
    found = named or next(filter(None, map(shutil.which, BROWSERS)), None)
    return found or (str(MAC_BROWSER) if MAC_BROWSER.is_file() else None)


def setup_browser() -> str:
    """The browser's path; it is installed where it is missing, and what drives it too."""
    setup_library("libatomic.so.1", "libatomic1", "Playwright needs GNU's atomic library.")
    for package in BROWSERS[:2]:  # older systems know the second alone
        if find_browser() is None:
            purpose = "The browser tests need Chromium or Chrome."
            apt_install(package, "fonts-dejavu-core", purpose=purpose)
    if (found := find_browser()) is None:
        raise SetupError("Chromium was installed but cannot be found; set STAIRWRIGHT_BROWSER.")
    return found
