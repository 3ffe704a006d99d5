"""Octave's `sqp` on the pose problem: functions written out as Octave code, one process kept."""

from __future__ import annotations

import atexit
import subprocess
import tempfile
from pathlib import Path

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from pose_tasks import Nlp

Floats = NDArray[np.float64]

_BINARY = {
    ca.OP_ADD: "+", ca.OP_SUB: "-", ca.OP_MUL: "*", ca.OP_DIV: "/", ca.OP_LT: "<", ca.OP_LE: "<=",
    ca.OP_EQ: "==", ca.OP_NE: "!=", ca.OP_AND: "&&", ca.OP_OR: "||",
    ca.OP_POW: "^", ca.OP_CONSTPOW: "^",
}  # fmt: skip
_CALLS = {
    ca.OP_SQRT: "sqrt", ca.OP_SIN: "sin", ca.OP_COS: "cos", ca.OP_TAN: "tan", ca.OP_ASIN: "asin",
    ca.OP_ACOS: "acos", ca.OP_ATAN: "atan", ca.OP_EXP: "exp", ca.OP_LOG: "log", ca.OP_FABS: "abs",
    ca.OP_SIGN: "sign", ca.OP_FMIN: "min", ca.OP_FMAX: "max", ca.OP_ATAN2: "atan2",
    ca.OP_HYPOT: "hypot", ca.OP_COPYSIGN: "copysign",
}  # fmt: skip
_UNARY = {
    ca.OP_ASSIGN: "{}", ca.OP_NEG: "-{}", ca.OP_SQ: "{0}*{0}", ca.OP_TWICE: "2*{}",
    ca.OP_INV: "1/{}", ca.OP_NOT: "!{}",
}  # fmt: skip
# A solve: derivatives exact, the answer in full precision. Equal bounds become an equation, since
# sqp takes the two for a quadratic program without solution.
_SOLVE = """
function one_pose(x0, p, lower, upper, equal, kept, least, most)
  functions = {@(x) NAME_f(x, p), @(x) NAME_df(x, p)(:)};
  fixed = find(lower == upper); there = lower(fixed); rows = eye(numel(x0))(fixed, :);
  lower(fixed) = -realmax; upper(fixed) = realmax;
  same = {@(x) [NAME_g(x, p)(equal); x(fixed) - there], @(x) [NAME_dg(x, p)(equal, :); rows]};
  more = {@(x) NAME_g(x, p)(kept) - least, @(x) NAME_dg(x, p)(kept, :)};
  x = sqp(x0, functions, same, more, lower, upper, most, 1e-8);
  printf("%.17g ", x); printf("\\n"); fflush(stdout);
end
"""


def source(function: ca.Function, name: str) -> str:
    """Octave code of a CasADi function of scalars (SX) with two inputs and one output."""
    rows, columns = function.size_out(0)
    places = function.sparsity_out(0)
    where = [1 + r + rows * c for r, c in zip(*places.get_triplet(), strict=True)]
    lines = [f"function out = {name}(x, p)", f"out = zeros({rows}, {columns});"]
    for k in range(function.n_instructions()):
        kind = function.instruction_id(k)
        ins, outs = function.instruction_input(k), function.instruction_output(k)
        args = [f"w{i}" for i in ins]
        if kind == ca.OP_CONST:
            text = f"w{outs[0]} = {function.instruction_constant(k)!r};"
        elif kind == ca.OP_INPUT:
            text = f"w{outs[0]} = {'xp'[ins[0]]}({ins[1] + 1});"
        elif kind == ca.OP_OUTPUT:
            text = f"out({where[outs[1]]}) = w{ins[0]};"
        elif kind in _BINARY:
            text = f"w{outs[0]} = {args[0]} {_BINARY[kind]} {args[1]};"
        elif kind in _UNARY:
            text = f"w{outs[0]} = {_UNARY[kind].format(args[0])};"
        elif kind == ca.OP_IF_ELSE_ZERO:
            text = f"if {args[0]}, w{outs[0]} = {args[1]}; else, w{outs[0]} = 0; end"
        else:
            text = f"w{outs[0]} = {_CALLS[kind]}({', '.join(args)});"
        lines.append(text)
    return "\n".join([*lines, "end", ""])


class Octave:
    """A running Octave that solves one pose at a time."""

    def __init__(self, executable: str, most: int) -> None:
        self._most = most
        self._folder = tempfile.TemporaryDirectory(prefix="stairwright-octave-")
        self._names: dict[int, str] = {}
        self._process = subprocess.Popen(
            [executable, "--quiet", "--no-history", "--no-init-file"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1,
            cwd=self._folder.name, start_new_session=True,
        )  # fmt: skip
        atexit.register(self.close)

    def close(self) -> None:
        """End the process and remove its folder."""
        self._process.kill()
        self._process.wait()
        self._folder.cleanup()

    def __call__(self, nlp: Nlp, guess: Floats) -> Floats:
        kept = ~nlp.equal & np.isfinite(nlp.least)
        numbers = (
            guess, nlp.parameters, nlp.lower, nlp.upper, 1.0 + np.flatnonzero(nlp.equal),
            1.0 + np.flatnonzero(kept), nlp.least[kept],
        )  # fmt: skip
        self._say(f"{self._written(nlp)}_solve({', '.join(map(_vector, numbers))}, {self._most});")
        assert self._process.stdout is not None
        return np.array(self._process.stdout.readline().split(), float)

    def _written(self, nlp: Nlp) -> str:
        """The name under which the functions of such a problem are known; written down once."""
        key = id(nlp.functions)
        if key not in self._names:
            name = self._names[key] = f"pose{len(self._names)}"
            folder = Path(self._folder.name)
            for part in ("f", "g", "df", "dg"):
                code = source(getattr(nlp.functions, part), f"{name}_{part}")
                (folder / f"{name}_{part}.m").write_text(code)
            solve = _SOLVE.replace("one_pose", f"{name}_solve").replace("NAME", name)
            (folder / f"{name}_solve.m").write_text(solve)
            self._say("rehash();")
        return self._names[key]

    def _say(self, line: str) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(line + "\n")
        self._process.stdin.flush()


def _vector(values: Floats) -> str:
    return "[" + ";".join(repr(float(v)) for v in values) + "]"
