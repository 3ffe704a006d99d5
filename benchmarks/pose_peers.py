"""Solvers of the pose problem: Stairwright's and its peers, all from the same first guesses."""

from __future__ import annotations

import importlib.util
import shutil
from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import NDArray
from octave_peer import Octave
from pose_tasks import Nlp, Numbers, Task
from scipy.optimize import minimize

from stairwright import _core
from stairwright.planning.poses.pose_search import CLEARANCE, LEGS_DISTANCE

Floats = NDArray[np.float64]
Solver = Callable[[Task], tuple[Floats, Floats]]

_GOOD = 1e-6  # m and rad; the largest violation with which a solver is done
_MOST = 200  # iterations


def stairwright(task: Task) -> tuple[Floats, Floats]:
    """The native SQP, preparation of terrain and robot included."""
    numbers = Numbers(task)
    search = numbers.search
    found = []
    for k in range(2):
        lower, upper = numbers.bounds(k)
        asked = _core.PoseTask(
            numbers.wanted[k], search.rules.weights, lower, upper, CLEARANCE, LEGS_DISTANCE,
            numbers.hip, True, (-np.inf, np.inf),
        )  # fmt: skip
        for guess in numbers.guesses(k):
            solution = search.problem.solve(asked, guess[[0, 1, 2, 7, 8]])
            if solution.violation <= _GOOD:
                break
        found.append(solution.x)
    return found[0], found[1]


def _each(one: Callable[[Nlp, Floats], Floats]) -> Solver:
    """A solver of tasks from a solver of one NLP and one first guess."""

    def solve(task: Task) -> tuple[Floats, Floats]:
        numbers = Numbers(task)
        found = []
        for k in range(2):
            nlp = Nlp(numbers, k)
            for guess in numbers.guesses(k):
                x = one(nlp, np.clip(guess, nlp.lower, nlp.upper))
                if _violation(nlp, x) <= _GOOD:
                    break
            found.append(x)
        return found[0], found[1]

    return solve


def _violation(nlp: Nlp, x: Floats) -> float:
    if not np.all(np.isfinite(x)):
        return np.inf
    g = nlp.rows(x)
    return float(max(np.max(nlp.least - g), np.max(g - nlp.most), 0.0))


def _casadi(plugin: str, options: dict[str, object]) -> Solver:
    import casadi as ca

    def one(nlp: Nlp, guess: Floats) -> Floats:
        solvers = nlp.functions.solvers
        if plugin not in solvers:
            solvers[plugin] = ca.nlpsol("pose", plugin, nlp.functions.sparse, options)
        result = solvers[plugin](
            x0=guess, p=nlp.parameters, lbx=nlp.lower, ubx=nlp.upper, lbg=nlp.least, ubg=nlp.most
        )
        return np.asarray(result["x"], float).ravel()

    return _each(one)


def _slsqp(exact: bool) -> Solver:
    def one(nlp: Nlp, guess: Floats) -> Floats:
        kept = ~nlp.equal & np.isfinite(nlp.least)

        def part(
            which: NDArray[np.bool_],
        ) -> tuple[Callable[[Floats], Floats], Callable[[Floats], Floats]]:
            return (
                lambda x: nlp.rows(x)[which] - nlp.least[which],
                lambda x: nlp.jacobian(x)[which],
            )

        constraints = []
        for kind, which in (("eq", nlp.equal), ("ineq", kept)):
            value, slope = part(which)
            constraints.append({"type": kind, "fun": value, **({"jac": slope} if exact else {})})
        result = minimize(
            nlp.cost, guess, jac=nlp.gradient if exact else None, method="SLSQP",
            bounds=list(zip(nlp.lower, nlp.upper, strict=True)), constraints=constraints,
            options={"maxiter": _MOST, "ftol": 1e-9},
        )  # fmt: skip
        return np.asarray(result.x, float)

    return _each(one)


def _drake() -> Solver:
    from pydrake.autodiffutils import ExtractGradient, ExtractValue, InitializeAutoDiff
    from pydrake.solvers import MathematicalProgram, SnoptSolver

    def differentiable(
        value: Callable[[Floats], Floats], slope: Callable[[Floats], Floats]
    ) -> Callable[[NDArray[np.object_]], object]:
        """The function as Drake calls it: with numbers, or with numbers and their derivatives."""

        def function(x: NDArray[np.object_]) -> object:
            if x.dtype != object:
                return value(x)
            at = ExtractValue(x).ravel()
            gradient = slope(at) @ ExtractGradient(x)
            return InitializeAutoDiff(value(at)[:, None], gradient).ravel()

        return function

    def one(nlp: Nlp, guess: Floats) -> Floats:
        program = MathematicalProgram()
        x = program.NewContinuousVariables(9)
        kept = np.isfinite(nlp.least)
        program.AddBoundingBoxConstraint(nlp.lower, nlp.upper, x)
        rows_of = differentiable(lambda v: nlp.rows(v)[kept], lambda v: nlp.jacobian(v)[kept])
        program.AddConstraint(rows_of, nlp.least[kept], nlp.most[kept], x)
        cost = differentiable(lambda v: np.array([nlp.cost(v)]), lambda v: nlp.gradient(v)[None, :])
        program.AddCost(lambda v: np.ravel(cost(v))[0], x)
        result = SnoptSolver().Solve(program, guess, None)
        return np.asarray(result.GetSolution(x), float)

    return _each(one)


@cache
def _octave(executable: str) -> Solver:
    return _each(Octave(executable, _MOST))


_QUIET = {"print_time": False, "error_on_fail": False}
_SQP = {
    **_QUIET, "qpsol": "daqp", "qpsol_options": {"error_on_fail": False}, "max_iter": 50,
    "tol_pr": 1e-8, "tol_du": 1e-6, "convexify_strategy": "eigen-clip",
    "print_header": False, "print_iteration": False, "print_status": False,
}  # fmt: skip
_IPOPT = {
    **_QUIET, "ipopt.print_level": 0, "ipopt.sb": "yes", "ipopt.max_iter": _MOST,
    "ipopt.tol": 1e-7, "ipopt.constr_viol_tol": 1e-8,
}  # fmt: skip


def peers() -> dict[str, Solver | str]:
    """Peers by name, or why one cannot be measured."""
    octave = shutil.which("octave-cli")
    drake = importlib.util.find_spec("pydrake") is not None
    return {
        "CasADi sqpmethod, daqp": _casadi("sqpmethod", _SQP),
        "CasADi IPOPT": _casadi("ipopt", _IPOPT),
        "SciPy SLSQP, exact derivatives": _slsqp(exact=True),
        "SciPy SLSQP, finite differences": _slsqp(exact=False),
        "Drake SNOPT": _drake() if drake else "not installed",
        "Octave sqp, exact derivatives": _octave(octave) if octave else "not installed",
    }
