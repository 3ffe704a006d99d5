"""Critical poses over many places of the rear wheel: the same problem solved, judged, compared."""

from __future__ import annotations

import math
from typing import NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.terrain.wheel_path import curve_at

from .cells import Course
from .gaps import collect
from .places import ground_below, room
from .rows import Task, new_rows
from .solve import solve_pose
from .state import Body, State, com, new_state, place

Floats = NDArray[np.float64]

TOLERANCE = 1e-6  # m and rad; a solution violates no constraint by more
WANTED = 0.05  # m of CoM margin beyond which other things decide
ENOUGH = 3  # poses with the room wanted; then the search ends
GRID = 0.05  # m between the rear wheel places that are tried
_FACE = 2e-3  # m past a corner, where the face ahead alone carries the wheel
PULLS = 3  # times that the trunk is asked to move until the CoM has room
_SETTLED = 1e-3  # m; such a move is none
_SAME = 3e-3  # m; so little another pull changes nothing
_USUAL = 4  # first guesses; the last one's trunk is higher and turned towards what comes
_HIGHER, _RAISED = 0.3, 0.6  # nominal heights, rad
_PITCHES = (-1.2, -0.6, 0.0, 0.6, 1.2)  # rad, first guesses of the patient search
_HEIGHTS = (0.5, 0.8, 1.1)  # of the nominal height, above the wheels' middle, likewise

COST, VIOLATION, MARGIN, TURN = 0, 1, 2, 3  # columns of a found pose's numbers


class Rules(NamedTuple):
    """What all poses of one plan keep. SI units.

    Attributes:
        friction: Between wheels and terrain.
        weights: (7,) of eq 17.
        lower, upper: (9,) bounds; those of the wheels are filled in for each pose.
        clearance: Of trunk and links from the ground.
        apart: Of the front leg from the rear one.
        hip: Of the rear contact behind the rear hip (eq 20).
        links: Keep whole links clear, not only the collision points.
        box: Half the way in which the rear wheel finds its place.
    """

    friction: float
    weights: Floats
    lower: Floats
    upper: Floats
    clearance: float
    apart: float
    hip: float
    links: bool
    box: float


class Wish(NamedTuple):
    """Where a pose is wanted; see `planning.pose_search.Place`."""

    front: float
    rear_low: float
    rear_high: float
    ahead: bool
    face: float
    climbs: bool
    posture: Floats


@leaf
def reference(body: Body, course: Course, x: float, out: Floats) -> None:
    """Fill (7,) the trunk and joints that eq 17 pulls to: nominal height over the ground below."""
    ground = ground_below(course, x + body.rear.hip_x, x + body.front.hip_x)
    out[0], out[1], out[2] = x, ground + body.planar.nominal_height, 0.0
    for k in range(4):
        out[3 + k] = body.standing[k]


@nb.njit(cache=True)
def search(
    body: Body, course: Course, rules: Rules, wish: Wish, rears: Floats, x: Floats, numbers: Floats
) -> int:
    """Solve with the rear wheel near each of `rears`, until enough poses have room.

    Args:
        body: The robot.
        course: The terrain.
        rules: What every pose keeps.
        wish: Where the pose is wanted.
        rears: Arc lengths of the rear wheel.
        x: (n, 9) filled with solved poses.
        numbers: (n, 4) filled with their cost, violation, margin [m], turn [rad^2].

    Returns:
        The number of poses found.
    """
    count, good = 0, 0
    start = np.full(5, np.nan)
    for rear in rears:
        solve_at(body, course, rules, wish, rear, start, False, x[count], numbers[count])
        if numbers[count, VIOLATION] <= TOLERANCE:
            start[:3], start[3:] = x[count, :3], x[count, 7:]
            good += numbers[count, MARGIN] >= 0.99 * WANTED
            count += 1
            if good >= ENOUGH:
                break
    return count


@nb.njit(cache=True)
def solve_at(
    body: Body, course: Course, rules: Rules, wish: Wish, rear: float, start: Floats, patient: bool,
    x: Floats, numbers: Floats,
) -> None:  # fmt: skip
    """The optimal pose with the rear wheel near `rear`.

    The trunk is first pulled to the middle between the wheels, then, where that leaves the centre
    of mass less room than `WANTED`, by what is missing.

    Args:
        body, course, rules, wish, rear: See `search`.
        start: (5,) first guess, or nan.
        patient: Try many first guesses where the usual ones find nothing.
        x: (9,) filled with the pose.
        numbers: (4,) filled with cost, violation, margin, turn.
    """
    lower, upper = rules.lower.copy(), rules.upper.copy()
    lower[7] = upper[7] = wish.front
    lower[8] = max(wish.rear_low, rear - rules.box)
    upper[8] = max(lower[8], min(wish.rear_high, rear + rules.box))
    hip = rules.hip if wish.climbs else -np.inf
    wanted, st = np.empty(7), new_state(body, True)
    fx, _, _, _ = curve_at(course.pieces, course.radius, wish.front)
    rx, _, _, _ = curve_at(course.pieces, course.radius, rear)
    middle = (fx + rx) / 2
    first, trial = start.copy(), np.empty(9)
    numbers[COST], numbers[VIOLATION] = np.inf, np.inf
    numbers[MARGIN], numbers[TURN] = -np.inf, np.inf
    for pull in range(PULLS):
        reference(body, course, middle, wanted)
        task = Task(
            wanted, rules.weights, lower, upper, rules.clearance, rules.apart, hip, rules.links,
            -np.inf, np.inf,
        )  # fmt: skip
        value, violation = _first_solution(
            body, course, task, wish, rear, first, patient and pull == 0, trial
        )
        solved = violation <= TOLERANCE
        shift, margin = 0.0, -np.inf
        if solved:
            shift, margin = com_shift(body, course, rules.friction, wish, trial, st)
        if pull == 0 or (solved and margin > numbers[MARGIN]):
            x[:] = trial
            numbers[COST], numbers[VIOLATION] = value, violation
            numbers[MARGIN], numbers[TURN] = margin, ((trial[2:7] - wish.posture) ** 2).sum()
        if not solved or abs(shift) < _SETTLED:
            break
        first[:3], first[3:] = trial[:3], trial[7:]
        moved = trial[0] + shift - middle
        if abs(moved) < _SAME:
            break
        middle += moved


@nb.njit(cache=True)
def _first_solution(
    body: Body, course: Course, task: Task, wish: Wish, rear: float, start: Floats, patient: bool,
    x: Floats,
) -> tuple[float, float]:  # fmt: skip
    """Cost and violation from the first guess that succeeds, else of the least violated."""
    fx, fz, _, _ = curve_at(course.pieces, course.radius, wish.front)
    rx, rz, _, _ = curve_at(course.pieces, course.radius, rear)
    z = max(task.reference[1], (fz + rz) / 2 + 0.5 * body.planar.nominal_height)
    line = -0.8 * math.atan2(fz - rz, max(fx - rx, 0.1))
    best, least = np.inf, np.inf
    trial, guess = np.empty(9), np.empty(5)
    x[:] = np.nan
    more = len(_PITCHES) * len(_HEIGHTS) if patient else 0
    for k in range(_USUAL + more):
        guess[:3] = task.reference[0], z, line
        guess[3], guess[4] = wish.front, rear
        if k == 0:
            if math.isnan(start[0]):
                continue
            guess[:] = start
        elif k == 2:
            guess[2] = wish.posture[0]
        elif k == 3:
            guess[1] += _HIGHER * body.planar.nominal_height
            guess[2] = -_RAISED if wish.climbs else _RAISED
        elif k >= _USUAL:
            pitch = _PITCHES[(k - _USUAL) % len(_PITCHES)]
            height = _HEIGHTS[(k - _USUAL) // len(_PITCHES)]
            guess[2] = pitch
            guess[1] = (fz + rz) / 2 + height * body.planar.nominal_height
        value, violation, _ = solve_pose(body, course, task, guess, trial)
        if violation < least:
            best, least = value, violation
            x[:] = trial
        if least <= TOLERANCE:
            break
    return best, least


@nb.njit(cache=True)
def slacks(
    body: Body, course: Course, rules: Rules, poses: Floats, coms: Floats, joints: Floats
) -> Floats:
    """Least slack (n,) of limits, clearances and balance [m or rad]; -inf out of reach.

    Args:
        body: The robot.
        course: The terrain.
        rules: Limits and clearances; eq 20 is left out.
        poses: (n, 5) x, z, pitch, arc lengths of the wheels.
        coms: (n, 2) least and largest x of the centre of mass [m].
        joints: (n, 4) filled with the joints, nan out of reach.
    """
    out, rows, st, none = np.empty(len(poses)), new_rows(), new_state(body, True), np.zeros(7)
    for i in range(len(poses)):
        if not place(body, course, poses[i], st):
            out[i], joints[i] = -np.inf, np.nan
            continue
        lower, upper = rules.lower.copy(), rules.upper.copy()
        lower[7:], upper[7:] = poses[i, 3:], poses[i, 3:]
        task = Task(
            none, none, lower, upper, rules.clearance, rules.apart, -np.inf, True,
            coms[i, 0], coms[i, 1],
        )  # fmt: skip
        out[i] = collect(body, course, task, st, rows)[1]
        joints[i] = st.q
    return out


@nb.njit(cache=True)
def com_shift(
    body: Body, course: Course, friction: float, wish: Wish, x: Floats, st: State
) -> tuple[float, float]:
    """Least shift of the CoM that gives it the room wanted, and the room that it has [m].

    `x` (9,) is a solved pose; `st` is scratch.
    """
    y = np.empty(5)
    y[:3], y[3:] = x[:3], x[7:]
    place(body, course, y, st)
    at = com(st, 0)
    low, high = room(course, x[7], x[8], friction)
    # Just after the first pose the face alone carries the front wheel; on the way down it still
    # does just before the second one, and there the CoM has the least time to move on.
    if wish.ahead or not wish.climbs:
        on_face = x[7] + _FACE if wish.ahead else wish.face
        a, b = room(course, on_face, x[8], friction)
        if max(low, a) <= min(high, b):
            low, high = max(low, a), min(high, b)
    if low > high:
        return 0.0, -np.inf
    spare = min(WANTED, (high - low) / 2)
    wanted = min(max(at, low + spare), high - spare)
    return wanted - at, min(at - low, high - at)
