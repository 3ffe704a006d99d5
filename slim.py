"""Make an environment smaller: `python slim.py` in the environment that is meant.

Many wheels hold what running this product never reads: their own tests, C headers and static
libraries, documentation of build tools, an application, solvers that are not offered here. And a
wheel cannot hold links: CasADi's libraries come two or three times under different names. Both go:
files of the lists below are removed, files with the same content become hard links to one.

Only packages that are named here, and folders called `tests`, are touched. Run again after each
installation; what is gone already does not matter.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
import sysconfig
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

SMALLEST = 4096  # bytes; sharing smaller files saves nothing
# CasADi finds solvers by the names of their libraries. This product uses IPOPT and, small, daqp.
OTHER_SOLVERS = (
    *("Cbc", "Cgl", "Clp", "CoinUtils", "Osi", "alpaqa", "antlr4", "blasfeo", "bonmin", "fatrop"),
    *("highs", "hpipm", "lacemodelica", "osqp", "piqp", "proxqp", "sipopt", "sleqp", "uno"),
    *("casadi_graphmodel", "casadi_onnx"),
)
NEEDLESS = {
    "casadi": (
        *(f"lib{solver}*" for solver in OTHER_SOLVERS),
        *(f"libcasadi_nlpsol_{name}.*" for name in ("alpaqa", "bonmin", "fatrop", "sleqp", "uno")),
        *("include", "cmake", "pkgconfig", "*.a", "*.la", "cbc", "clp", "highs"),
    ),
    "cmake/data": ("doc", "bin/c[pt]*", "share/cmake-*/Help", "share/vim", "share/emacs"),
    "mujoco": ("studio", "_render_filament.*", "doc", "*_test.py"),
    "numpy": ("_core/lib/*.a", "random/lib/*.a"),
    "zstandard": ("_cffi.*",),  # the other of two forms of the same
    ".": ("setuptools", "pkg_resources", "_distutils_hack", "distutils-precedence.pth"),
}


def needless(packages: Path) -> Iterator[Path]:
    """Files and folders that nothing here reads."""
    for package, patterns in NEEDLESS.items():
        for pattern in patterns:
            yield from (packages / package).glob(pattern)
    yield from (path for path in packages.rglob("tests") if path.is_dir())


def remove(packages: Path) -> None:
    """Remove what is needless."""
    for path in [*needless(packages)]:
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)


def share(packages: Path) -> None:
    """Make files with the same content one file under several names."""
    by_size: dict[tuple[int, int], list[Path]] = defaultdict(list)
    for path in sorted(packages.rglob("*")):
        status = path.lstat()
        if path.is_file() and not path.is_symlink() and status.st_size >= SMALLEST:
            by_size[status.st_size, status.st_mode].append(path)
    for alike in by_size.values():
        first: dict[bytes, Path] = {}
        for path in alike if len(alike) > 1 else ():
            same = first.setdefault(hashlib.sha256(path.read_bytes()).digest(), path)
            if not same.samefile(path):
                _link(same, path)


def _link(same: Path, path: Path) -> None:
    link = path.with_name(f"{path.name}.link")
    link.unlink(missing_ok=True)
    try:
        os.link(same, link)
    except OSError:
        return  # a file system without hard links keeps two files
    link.replace(path)


if __name__ == "__main__":
    folder = Path(sysconfig.get_path("purelib"))
    if sys.prefix == sys.base_prefix:
        sys.exit(f"{folder} is the system's: run this with the Python of a virtual environment")
    remove(folder)
    share(folder)
