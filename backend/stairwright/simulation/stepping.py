"""MuJoCo's `mj_step` called from compiled code.

A control step takes some 30 us of physics and 4 us of control; Python between the two would cost
as much as both controllers. So the loop is compiled, and calls MuJoCo's C function by its address.
It also runs without Python's lock, so that threads can simulate side by side.
"""

from __future__ import annotations

import ctypes
import functools
import platform
from pathlib import Path
from typing import Any

import mujoco
from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.extending import intrinsic

_NAMES = {"Windows": "mujoco.dll", "Darwin": "libmujoco.*.dylib"}


@functools.cache
def step_address() -> int:
    """Address of `mj_step` in the library that the package `mujoco` has loaded.

    Raises:
        RuntimeError: If the package holds no such library.
    """
    folder = Path(mujoco.__file__).parent
    pattern = _NAMES.get(platform.system(), "libmujoco.so.*")
    for file in sorted(folder.glob(pattern)):
        function = ctypes.CDLL(str(file)).mj_step
        return int(ctypes.cast(function, ctypes.c_void_p).value or 0)
    raise RuntimeError(f"found no {pattern} in {folder}")


def addresses(model: Any, data: Any) -> tuple[int, int, int]:
    """What `call_step` needs: addresses of `mj_step`, of an `MjModel` and of its `MjData`."""
    return step_address(), int(model._address), int(data._address)  # noqa: SLF001


@intrinsic
def call_step(_typing: Any, _function: Any, _model: Any, _data: Any) -> Any:
    """``mj_step(model, data)`` by `addresses`, in compiled code only."""
    signature = types.void(types.intp, types.intp, types.intp)

    def generate(context: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        word = context.get_value_type(types.intp)
        kind = ir.FunctionType(ir.VoidType(), [word, word])
        pointer = builder.inttoptr(arguments[0], kind.as_pointer())
        builder.call(pointer, arguments[1:])
        return context.get_dummy_value()

    return signature, generate
