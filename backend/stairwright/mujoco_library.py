"""MuJoCo's shared library, which the native core needs when it is loaded.

It lies in the package `mujoco`, wherever that is installed, so the core's own search path cannot
name it for every kind of installation. Loading it takes milliseconds; importing `mujoco` takes a
hundred times as long, and not every process needs that.
"""

from __future__ import annotations

import ctypes
import importlib.util
from pathlib import Path

_NAMES = ("libmujoco.so.*", "libmujoco.*.dylib")


def load_mujoco_library() -> None:
    """Load the library, so that whoever links it finds it.

    Raises:
        ImportError: If the package `mujoco` is not installed or holds no library.
    """
    spec = importlib.util.find_spec("mujoco")
    folders = list(spec.submodule_search_locations or ()) if spec else []
    for folder in map(Path, folders):
        for library in (file for name in _NAMES for file in sorted(folder.glob(name))):
            ctypes.CDLL(str(library))
            return
    raise ImportError(f"MuJoCo's shared library is missing; looked in {folders or 'no folder'}")
