"""How the innermost compiled functions are compiled: they borrow arrays instead of sharing them.

Numba counts references to every array of every struct that a function is given, at each call. For
small functions that takes longer than what they do: 0.2 us for a struct of ten arrays. A leaf goes
without. The compiler refuses one that makes an array itself; one that is *given* an array by a
function that it calls would never free it; and what a leaf calls is compiled as it is. So leaves
call only leaves, functions of numbers and what is inlined, which a test holds them to.

Numba keeps what it has compiled by the text of a function, not by these options: remove
`__pycache__` after changing them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numba as nb
from numba.core import event
from numba.core.cpu import CPUTargetOptions

from . import preparing

F = TypeVar("F", bound=Callable[..., Any])

_BORROWING: dict[str, Any] = {"cache": True}
if hasattr(CPUTargetOptions, "_nrt"):  # without, leaves are as slow as others, no more
    _BORROWING["_nrt"] = False


class _Listener(event.Listener):  # type: ignore[misc]
    """Hands on that a function was compiled, rather than loaded."""

    def on_start(self, event: event.Event) -> None:
        """Called by numba."""

    def on_end(self, event: event.Event) -> None:
        """Called by numba."""
        preparing.compiled(str(event.data["dispatcher"].py_func.__name__))


event.register("numba:compile", _Listener())  # type: ignore[no-untyped-call]


def leaf(function: F) -> F:
    """Compile a function that neither makes an array nor returns one."""
    compiled: F = nb.njit(**_BORROWING)(function)
    return compiled


def vector_leaf(function: F) -> F:
    """The same for loops that the processor's vector units shall take.

    Sums may be taken in any order, and a division by zero is not noticed.
    """
    compiled: F = nb.njit(**_BORROWING, error_model="numpy", fastmath=True)(function)
    return compiled
