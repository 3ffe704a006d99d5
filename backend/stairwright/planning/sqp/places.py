"""What the ground offers the wheels: contacts, room for the centre of mass, where a wheel rests."""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.planning.path.contacts import wheel_contacts
from stairwright.statics.contact import com_interval
from stairwright.terrain.wheel_path import curve_at, ground_height

from .cells import Course

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

CONTACTS = 4  # at most, of both wheel pairs
SETTLE = 0.10  # m that a resting rear wheel is past steep ground, for legs of 0.4 m
GRIP = 0.9  # of the friction angle: steeper ground does not hold a resting wheel alone
_AHEAD, _STRIDE = 3.0, 0.005  # m that steep ground is looked for ahead, and how finely
_BELOW = 15  # samples of the ground below the trunk


@leaf
def contacts(
    course: Course, front: float, rear: float, points: Floats, normals: Floats, owner: Ints
) -> int:
    """Contacts of the wheels at arc lengths `front` and `rear`: two each at concave corners.

    Args:
        course: The terrain.
        front: Arc length of the front wheels [m].
        rear: Of the rear ones.
        points: (CONTACTS, 2) filled with contact points [m].
        normals: (CONTACTS, 2) filled with unit normals out of the terrain.
        owner: (CONTACTS,) filled with 0 for front and 1 for rear wheels.

    Returns:
        The number of contacts.
    """
    count = 0
    for wheel in range(2):
        begin = count
        count += wheel_contacts(
            course.pieces, course.corners, course.radius, front if wheel == 0 else rear,
            points, normals, begin,
        )  # fmt: skip
        owner[begin:count] = wheel
    return count


@nb.njit(cache=True)
def room(course: Course, front: float, rear: float, friction: float) -> tuple[float, float]:
    """Least and largest x of the CoM [m] that the friction cones can hold; low > high: none.

    The wheels are at arc lengths `front` and `rear`.
    """
    points, normals = np.empty((CONTACTS, 2)), np.empty((CONTACTS, 2))
    owner = np.empty(CONTACTS, np.int64)
    count = contacts(course, front, rear, points, normals, owner)
    return com_interval(points, normals, count, friction)


@nb.njit(cache=True)
def rooms(course: Course, wheels: Floats, friction: float) -> Floats:
    """Rows (low, high) of `room` for rows (front, rear) of arc lengths."""
    out = np.empty((len(wheels), 2))
    for i in range(len(wheels)):
        out[i, 0], out[i, 1] = room(course, wheels[i, 0], wheels[i, 1], friction)
    return out


@leaf
def slope(course: Course, s: float) -> float:
    """Angle of the ground's normal at `s` from the vertical [rad], never negative."""
    _, _, nx, nz = curve_at(course.pieces, course.radius, s)
    return abs(math.atan2(nx, nz))


@leaf
def settled(course: Course, s: float, friction: float, size: float) -> bool:
    """Whether a wheel at `s` rests: on ground that holds it, and well past any that does not.

    A wheel that has only just climbed an edge would leave the whole climb to the short way of the
    other wheel before.
    """
    most = GRIP * math.atan(friction)
    for k in range(5):  # noqa: SIM110 (compiled)
        if slope(course, max(0.0, s - 0.25 * k * SETTLE * size)) > most:
            return False
    return True


@leaf
def steep_ahead(course: Course, s: float, friction: float, size: float) -> float:
    """Arc length of the next ground that does not hold a resting wheel alone, or inf."""
    most = GRIP * math.atan(friction)
    for k in range(int(_AHEAD * size / _STRIDE)):
        if slope(course, s + k * _STRIDE) > most:
            return s + k * _STRIDE
    return np.inf


@leaf
def ground_below(course: Course, low: float, high: float) -> float:
    """Mean height of the ground between two abscissas [m]; constant beyond its ends."""
    p, total = course.vertices, 0.0
    for k in range(_BELOW):
        x = low + (high - low) * k / (_BELOW - 1)
        total += ground_height(p, min(max(x, p[0, 0]), p[-1, 0]))
    return total / _BELOW


@nb.njit(cache=True)
def rear_places(
    course: Course, front: float, face: float, low: float, high: float, spread: tuple[float, float],
    step: float, usual: float, friction: float, size: float, gentle: bool,
) -> Floats:  # fmt: skip
    """Arc lengths of the rear wheel worth trying, from the place like standing outward.

    Args:
        course: The terrain.
        front: Arc length of the front wheel [m].
        face: Where the front wheel is on the obstacle's face while the rear wheel stays: both must
            hold the robot together.
        low: Least arc length of the rear wheel.
        high: The largest.
        spread: Least and largest distance of the wheels' centres [m].
        step: Between places [m].
        usual: Distance of the wheels' centres of the place tried first [m].
        friction: Between wheels and terrain.
        size: Of the robot; legs of 0.4 m are 1.
        gentle: Rest the rear wheel only on ground that holds it alone.
    """
    low, high = max(low, front - 1.2 * spread[1]), min(high, front)
    if high < low:
        return np.empty(0)
    number = max(1, int((high - low) / step) + 1)
    out, far, count = np.empty(number), np.empty(number), 0
    fx, fz, _, _ = curve_at(course.pieces, course.radius, front)
    for k in range(number):
        s = low + (high - low) * k / max(1, number - 1)
        x, z, _, _ = curve_at(course.pieces, course.radius, s)
        gap = math.hypot(x - fx, z - fz)
        if not spread[0] <= gap <= spread[1]:
            continue
        if gentle and not settled(course, s, friction, size):
            continue
        a, b = room(course, face, s, friction)
        if a <= b:
            out[count], far[count] = s, abs(gap - usual)
            count += 1
    return out[:count][np.argsort(far[:count], kind="mergesort")]
