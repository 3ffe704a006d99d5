"""Where compiled kernels are kept if they cannot lie beside the code that they come from.

Numba takes the user's cache folder then, and fails at import for a user without a home.
"""

from __future__ import annotations

import atexit
import os
import shutil
import tempfile
from pathlib import Path

VARIABLE = "NUMBA_CACHE_DIR"


def keep_kernels(folder: Path | None = None) -> None:
    """Choose a folder before numba is imported; `folder` keeps them for the next start.

    Nothing is chosen where the code's own folder can be written, or somebody has chosen already.
    """
    if os.environ.get(VARIABLE) or os.access(Path(__file__).parent, os.W_OK):
        return
    if folder is None and os.access(os.path.expanduser("~"), os.W_OK):  # noqa: PTH111 - may fail
        return  # the user's cache folder does
    try:
        if folder is None:
            raise FileNotFoundError
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        # Never a name that others could guess: what lies there is executed.
        folder = Path(tempfile.mkdtemp(prefix="stairwright-kernels-"))
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
    os.environ[VARIABLE] = str(folder)
