"""Making an environment smaller: only what is named goes, and what is the same is kept once."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import slim

ROOT = Path(__file__).resolve().parents[1]


def write(path: Path, content: bytes) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)
    return path


def test_what_is_needless_goes_and_nothing_else(tmp_path: Path) -> None:
    gone = [
        *(write(tmp_path / "casadi" / name, b"") for name in ("libCbc.so.3", "libx.a")),
        write(tmp_path / "casadi" / "include" / "casadi.hpp", b""),
        write(tmp_path / "scipy" / "special" / "tests" / "test_it.py", b""),
        write(tmp_path / "cmake" / "data" / "share" / "cmake-4.4" / "Help" / "it.rst", b""),
    ]
    kept = [
        *(
            write(tmp_path / "casadi" / name, b"")
            for name in ("libipopt.so.3", "libcasadi_conic_daqp.so")
        ),
        write(tmp_path / "casadi" / "libcasadi_nlpsol_ipopt.so", b""),
        write(tmp_path / "numpy" / "testing" / "_private" / "utils.py", b""),
        write(tmp_path / "else" / "include" / "it.h", b""),
        write(tmp_path / "mujoco" / "include" / "mujoco.h", b""),
    ]
    slim.remove(tmp_path)
    slim.remove(tmp_path)
    assert not [path for path in gone if path.exists()]
    assert all(path.is_file() for path in kept)


def test_files_with_the_same_content_become_one(tmp_path: Path) -> None:
    same, other = b"a" * 5000, b"b" * 5000
    first, second = (write(tmp_path / f"lib{k}.so", same) for k in (1, 2))
    third = write(tmp_path / "lib3.so", other)
    program = write(tmp_path / "program", same)
    program.chmod(0o755)
    slim.share(tmp_path)
    slim.share(tmp_path)
    assert first.samefile(second)
    assert not first.samefile(program), "may be run, the others not"
    assert [path.read_bytes() for path in (first, second, third)] == [same, same, other]
    assert len([*tmp_path.iterdir()]) == 4


def test_the_systems_python_is_left_alone() -> None:
    base = Path(sys.base_prefix) / "bin" / f"python3.{sys.version_info.minor}"
    done = subprocess.run([base, ROOT / "slim.py"], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "virtual environment" in done.stderr
