"""The native core: a compiler, and the library that Python imports."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from .packages import pip_install, venv_python
from .places import BACKEND, LOCKS, NATIVE, PYTHON, STATE, VENV, ZIG_LOCK
from .running import SetupError, make_shim, run, say
from .steps import digest, step
from .system import apt_install

COMPILERS = ("g++", "clang++", "c++")


def find_compiler() -> str:
    """A C++20 compiler: the machine's, else the system packages', else Zig's from PyPI."""
    named = os.environ.get("CXX")
    if named and not shutil.which(named):
        raise SetupError(f"CXX names {named}, which cannot be run.")
    if found := named or next(filter(None, map(shutil.which, COMPILERS)), None):
        return found
    try:
        apt_install("g++", purpose="The native core needs a C++ compiler.")
    except SetupError as error:
        say(f"{error} Taking the compiler of the package ziglang instead ...")
    return shutil.which("g++") or str(setup_zig())


def setup_zig() -> Path:
    """Zig's C++ compiler under the names that CMake looks for."""
    home, shims = STATE / "zig", STATE / "zig-bin"
    with step("Zig", STATE / "zig.stamp", digest([ZIG_LOCK]), done=shims.is_dir()) as needed:
        if needed:
            shutil.rmtree(home, ignore_errors=True)
            shutil.rmtree(shims, ignore_errors=True)
            if why := pip_install("--target", home, "-r", ZIG_LOCK):
                raise SetupError(f"Zig cannot be installed: {why}")
            shims.mkdir()
            for name in ("c++", "ar", "ranlib"):
                make_shim(shims / name, home / "ziglang" / "zig", name)
    return shims / "c++"


def native_sources() -> list[Path]:
    """Everything that the native core is made of."""
    return [path for path in NATIVE.rglob("*") if path.is_file()]


def setup_native() -> None:
    """Build the native core into the package; only what has changed is compiled again."""
    compiler = find_compiler()
    wanted = digest(
        [*native_sources(), Path(__file__).resolve(), *LOCKS[:1]], venv_python(), compiler
    )
    built = any(BACKEND.glob("_core.*.so"))
    with step("The native core", STATE / "native.stamp", wanted, done=built) as needed:
        if needed:
            build_native(compiler, STATE / "native")


def build_native(compiler: str, folder: Path) -> None:
    """Configure, build and install the native core with CMake."""
    tools = VENV / "bin"
    options = [f"-DPython_EXECUTABLE={PYTHON}", f"-DCMAKE_CXX_COMPILER={compiler}"]
    if compiler.startswith(str(STATE)):
        options += [f"-DCMAKE_{tool}={STATE}/zig-bin/{tool.lower()}" for tool in ("AR", "RANLIB")]
    options.append(f"-DCMAKE_MAKE_PROGRAM={tools / 'ninja'}")
    run(tools / "cmake", "-S", NATIVE, "-B", folder, "-G", "Ninja", "--log-level=WARNING", *options)
    run(tools / "cmake", "--build", folder, "--", "--quiet")
    for old in BACKEND.glob("_core.*"):
        old.unlink()
    run(tools / "cmake", "--install", folder, "--prefix", BACKEND)
