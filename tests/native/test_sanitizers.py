"""The core built with AddressSanitizer and UBSan: hostile input leads to no fault."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
BUILD = ROOT / ".dev" / "native-sanitized"  # kept: ninja builds again what has changed
PARTS = ("terrains", "calls", "drawn", "robots", "wrecks")  # the longest first
ASAN = "detect_leaks=0,detect_stack_use_after_return=1,allocator_may_return_null=1,exitcode=99"
pytestmark = [pytest.mark.slow, pytest.mark.timeout(900)]


def _library(name: str) -> str:
    """Where g++ keeps a library; empty if it has none."""
    asked = subprocess.run(
        ["g++", f"-print-file-name={name}"], check=True, capture_output=True, text=True
    )
    found = asked.stdout.strip()
    return found if Path(found).is_file() else ""


def _build(*options: str) -> Path:
    """The build's folder after building what the options say."""
    tools = Path(sys.executable).parent
    configure = [tools / "cmake", "-S", ROOT / "native", "-B", BUILD, "-G", "Ninja", *options]
    configure += ["-DSTAIRWRIGHT_SANITIZE=ON", "-DSTAIRWRIGHT_EXAMPLES=ON"]
    configure += ["-DCMAKE_CXX_COMPILER=g++", f"-DCMAKE_MAKE_PROGRAM={tools / 'ninja'}"]
    for command in (configure, [tools / "cmake", "--build", BUILD]):
        built = subprocess.run(command, check=False, capture_output=True, text=True)
        assert built.returncode == 0, built.stdout[-3000:] + built.stderr[-3000:]
    return BUILD


@pytest.fixture(scope="module")
def without_python() -> Path:
    """The build's folder with the C++ example, built where neither Python nor MuJoCo is named."""
    if shutil.which("g++") is None or not _library("libasan.so"):
        pytest.skip("needs g++ and its sanitizers")
    return _build("-DSTAIRWRIGHT_PYTHON=OFF")


@pytest.fixture(scope="module")
def sanitized(without_python: Path) -> Path:
    """The same with the Python module, whose bindings are those of the core that is installed."""
    bindings = ROOT / ".dev" / "native"
    if not (bindings / "libnanobind-static.a").is_file():
        pytest.fail(f"no objects of the native core in {bindings}: run ./dev build")
    options = (f"-DSTAIRWRIGHT_BINDINGS={bindings}", f"-DPython_EXECUTABLE={sys.executable}")
    return _build("-DSTAIRWRIGHT_PYTHON=ON", *options)


def _under_sanitizers(core: Path, part: str) -> subprocess.CompletedProcess[str]:
    """A Python without sanitizers loads theirs first, and C++'s library: they see exceptions."""
    env = os.environ | {
        "LD_PRELOAD": f"{_library('libasan.so')} {_library('libstdc++.so.6')}",
        "ASAN_OPTIONS": ASAN,
        "UBSAN_OPTIONS": "print_stacktrace=1",
        "PYTHONMALLOC": "malloc",  # so that they see Python's memory, too
        "PYTHONPATH": str(ROOT / "backend"),
    }
    command = [sys.executable, ROOT / "tests" / "native" / "under_sanitizers.py", core, part]
    return subprocess.run(command, check=False, capture_output=True, text=True, env=env)


@pytest.fixture(scope="module")
def running(sanitized: Path) -> Iterator[dict[str, Future[subprocess.CompletedProcess[str]]]]:
    """All parts, as many at once as there are processors."""
    (core,) = sanitized.glob("_core.*.so")
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        yield {part: pool.submit(_under_sanitizers, core, part) for part in PARTS}


def test_the_controller_alone_leaks_nothing(without_python: Path) -> None:
    example = without_python / "control_steps"
    ran = subprocess.run(example, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr
    assert not ran.stderr
    assert ran.stdout.count("the wheels carry") == 5


@pytest.mark.parametrize("part", PARTS)
def test_nothing_is_found(
    running: dict[str, Future[subprocess.CompletedProcess[str]]], part: str
) -> None:
    done = running[part].result()
    assert done.returncode == 0, done.stdout[-1000:] + done.stderr[:6000]
    assert f"{part}: all done" in done.stdout


def test_a_fault_would_be_found(sanitized: Path, tmp_path: Path) -> None:
    """Reading one number beyond an array's end ends the process with a report."""
    source = tmp_path / "fault.cpp"
    source.write_text(
        "#include <vector>\nint main(int n, char**) { return std::vector<int>(n)[n] != n; }\n"
    )
    flags = next(
        line.removeprefix("  FLAGS = ").split()
        for line in (sanitized / "build.ninja").read_text().splitlines()
        if line.startswith("  FLAGS = ") and "-fsanitize" in line and "c++-header" not in line
    )
    program = tmp_path / "fault"
    subprocess.run(["g++", *flags, source, "-o", program], check=True)
    ran = subprocess.run(program, capture_output=True, text=True, check=False)
    assert ran.returncode != 0
    assert "AddressSanitizer" in ran.stderr
