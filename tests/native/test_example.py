"""The controller from C++ alone: the example builds without Python or MuJoCo, and runs."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

NATIVE = Path(__file__).parents[2] / "native"


@pytest.mark.slow
@pytest.mark.skipif(
    not all(map(shutil.which, ("cmake", "c++"))), reason="needs CMake and a C++ compiler"
)
def test_the_controller_needs_neither_python_nor_mujoco(tmp_path: Path) -> None:
    options = ["PYTHON=OFF", "EXAMPLES=ON"]
    flags = [f"-DSTAIRWRIGHT_{option}" for option in options] + ["-DCMAKE_BUILD_TYPE=Debug"]
    subprocess.run(["cmake", "-S", NATIVE, "-B", tmp_path, *flags], check=True, capture_output=True)
    subprocess.run(["cmake", "--build", tmp_path, "-j2"], check=True, capture_output=True)
    example = tmp_path / "control_steps"
    ran = subprocess.run([example], check=True, capture_output=True, text=True)
    assert ran.stdout.count("the wheels carry") == 5
