"""The native core for 64-bit ARM, as robots' computers have it."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from .locks import lock_blocks
from .native import setup_zig
from .packages import pip_install, setup_python
from .places import LOCKS, NATIVE, PYTHON, ROOT, STATE, VENV
from .running import SetupError, make_shim, run, say
from .steps import one_at_a_time, step

ARM64, AARCH64 = "aarch64-linux-gnu.2.28", 183  # Zig's name with the oldest glibc, ELF's number


def arm64() -> None:
    """Compile core, Python module, example and player for 64-bit ARM with Zig; in .dev/arm64."""
    with one_at_a_time():
        setup_python(LOCKS[:1])
        setup_zig()
        mujoco = setup_arm64_mujoco()
        zig, tools, folder = STATE / "zig" / "ziglang" / "zig", VENV / "bin", STATE / "arm64"
        compiler = STATE / "zig-bin" / "arm64-c++"
        version = f"{sys.version_info.major}{sys.version_info.minor}"
        make_shim(compiler, zig, "c++", "-target", ARM64)
        options = {
            "CMAKE_SYSTEM_NAME": "Linux",
            "CMAKE_SYSTEM_PROCESSOR": "aarch64",
            "CMAKE_CXX_COMPILER": compiler,
            "CMAKE_AR": STATE / "zig-bin" / "ar",
            "CMAKE_RANLIB": STATE / "zig-bin" / "ranlib",
            "CMAKE_MAKE_PROGRAM": tools / "ninja",
            "Python_EXECUTABLE": PYTHON,
            "SKBUILD_SOABI": f"cpython-{version}-aarch64-linux-gnu",  # names the module
            "CMAKE_CXX_FLAGS": "-Wno-macro-redefined",  # Python's headers are this machine's
            "MUJOCO_PACKAGE": mujoco,
            "STAIRWRIGHT_EXAMPLES": "ON",
            "STAIRWRIGHT_PLAYER": "ON",
        }
        given = [f"-D{name}={value}" for name, value in options.items()]
        with step("The native core for 64-bit ARM", folder / ".stamp", "always", done=False):
            quiet = "--log-level=WARNING"
            run(tools / "cmake", "-S", NATIVE, "-B", folder, "-G", "Ninja", quiet, *given)
            run(tools / "cmake", "--build", folder)
        programs = (folder / "control_steps", folder / "stairwright_player")
        made = [*folder.glob("_core.*.so"), *programs]
        for path in made:
            if elf_machine(path) != AARCH64:
                raise SetupError(f"{path} is not for 64-bit ARM.")
            say(f"For 64-bit ARM: {path.relative_to(ROOT)}")


def setup_arm64_mujoco() -> Path:
    """MuJoCo's package for 64-bit ARM, which the native core is linked with there."""
    home, lock = STATE / "mujoco-arm64", STATE / "mujoco.lock"
    block = next(block for block in lock_blocks(LOCKS[0]) if block.startswith("mujoco-core=="))
    with step("MuJoCo for 64-bit ARM", STATE / "mujoco-arm64.stamp", block) as needed:
        if needed:
            shutil.rmtree(home, ignore_errors=True)
            lock.write_text(block)
            target = ("--target", home, "--python-platform", "aarch64-manylinux_2_28")
            if why := pip_install(*target, "-r", lock):
                raise SetupError(f"MuJoCo for 64-bit ARM cannot be installed: {why}")
    return home / "mujoco"


def elf_machine(path: Path) -> int:
    """The kind of processor that a program or library of Linux is for, as ELF numbers them."""
    head = path.read_bytes()[:20]
    return int.from_bytes(head[18:20], "little") if head[:4] == b"\x7fELF" else 0
