"""A path retimed for a controller: from rest to rest, smooth, at a fixed rate.

A plan is a polyline in joint space with a time for each corner. Joint speeds step at its corners,
and it starts and ends at speed. Here it is followed more slowly where a limit asks for it, and its
corners are rounded:

1. The plan's clock is stretched where a speed is too high. The pace, seconds of that clock per
   second, is then at most 1 and as high as accelerations allow; a pass forward and one backward
   make it rise from 0 and fall to 0.
2. Places on the polyline, one every `KNOT_SPACING`, are the control points c_i of a uniform cubic
   B-spline with knot spacing h. At a knot its value is (c_{i-1} + 4 c_i + c_{i+1}) / 6, its rate
   (c_{i+1} - c_{i-1}) / 2h, its acceleration a_i = (c_{i-1} - 2 c_i + c_{i+1}) / h^2; between knots
   the acceleration is linear and the jerk (a_{i+1} - a_i) / h.

So the acceleration nowhere exceeds that at the knots, the jerk is at most 2 max|a| / h, and a
corner is cut by at most 0.27 max|a| h^2 (halfway between two control points). Where a limit is
exceeded all the same, because the pace changes there too, the pace is lowered until it is not.

Points are read off at knots and evenly between them, so cubic and quintic Hermite interpolation of
the points, which is what ros2_control does, gives back this very spline.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from stairwright.arrays import Flags, Floats
from stairwright.errors import InputError

KNOT_SPACING = 0.02  # s
MOST_POINTS = 250_000
_TURNING, _SPEEDING = 0.9, 0.5  # of the accelerations, for corners and for changing the pace
_CLOSER = 3  # looks at the corners that count at the pace found before
_CELLS = 4  # of the path per knot spacing
_CUT = 0.27  # of acceleration and squared spacing: how far a corner is cut at most
_ROUNDS = 200
_EASE = 0.8  # of the pace is kept where a limit is exceeded all the same


@dataclass(frozen=True)
class Limits:
    """Limits of the m channels of a path; infinite where there is none.

    Attributes:
        speed: (m,) per s.
        acceleration: (m,) per s^2.
        jerk: (m,) per s^3.
        tolerance: (m,) distance of the spline from the polyline.
    """

    speed: Floats
    acceleration: Floats
    jerk: Floats
    tolerance: Floats

    def accelerations(self, spacing: float) -> Floats:
        """Accelerations (m,) that keep tolerance and jerk too, for knots so far apart [s]."""
        cutting = self.tolerance / (_CUT * spacing**2)
        bounds = (self.acceleration, self.jerk * spacing / 2, cutting)
        return np.asarray(np.minimum.reduce(bounds))


@dataclass(frozen=True)
class Retimed:
    """Samples at even times from 0, at rest in the first two and in the last.

    Attributes:
        time: (n,) [s].
        values, rates, accelerations: (n, m) of the path's channels.
    """

    time: Floats
    values: Floats
    rates: Floats
    accelerations: Floats


def retime(clock: Floats, path: Floats, limits: Limits, rate: float) -> Retimed:
    """`path`, retimed and sampled `rate` times a second.

    Args:
        clock: (k,) the path's own times [s]; rising strictly.
        path: (k, m) corners of the polyline, linear between them; two or more.
        limits: Of the m channels.
        rate: Samples per second [Hz].

    Raises:
        InputError: If that would be more than `MOST_POINTS`, or no pace keeps the limits.
    """
    parts = max(1, round(KNOT_SPACING * rate))
    spacing = parts / rate
    _check_length(clock[-1] - clock[0], rate)
    most = limits.accelerations(spacing)
    hurry = _most(np.abs(np.diff(path, axis=0)) / limits.speed)
    clock = np.concatenate([[0.0], np.cumsum(np.maximum(np.diff(clock), hurry))])
    clock, path = _cut(clock, path, spacing / _CELLS)
    slope = np.diff(path, axis=0) / np.diff(clock)[:, None]
    cap = _caps(clock, slope, _TURNING * most, spacing)
    gain = _least((_SPEEDING * most)[None] / np.maximum(np.abs(slope), 1e-12))
    for _ in range(_ROUNDS):
        time = _times(clock, pace := _reachable(clock, cap, gain))
        _check_length(time[-1], rate)
        places = _places(clock, pace, time, spacing)
        points = _at(clock, path, places)
        fast = _too_fast(points, limits, spacing)
        fast |= _strays(points, places, clock, path, limits.tolerance)
        if not fast.any():
            return _sampled(points, spacing, parts)
        _ease(cap, clock, places, fast)
    raise InputError("no pace keeps the limits of this motion", ("poses",))


def _check_length(duration: float, rate: float) -> None:
    if not duration * rate < MOST_POINTS:
        raise InputError(
            f"a trajectory of {duration:.3g} s has more than {MOST_POINTS} points at {rate:g} Hz; "
            "a lower rate is needed",
            ("rate",),
        )


def _cut(clock: Floats, path: Floats, longest: float) -> tuple[Floats, Floats]:
    """The same polyline with corners at most `longest` apart on its clock [s]."""
    step = np.diff(clock)
    count = np.maximum(2, np.ceil(step / longest)).astype(int)  # the pace is 0 at both ends
    first = np.repeat(np.cumsum(count) - count, count)
    share = (np.arange(count.sum()) - first) / np.repeat(count, count)
    fine = np.append(np.repeat(clock[:-1], count) + share * np.repeat(step, count), clock[-1])
    return fine, _at(clock, path, fine)


def _caps(clock: Floats, slope: Floats, most: Floats, spacing: float) -> Floats:
    """Highest pace (k,) at each corner that keeps accelerations while the pace is even.

    At pace p the second difference of control points around corners is at most p h times the sum of
    the steps of the slope among them, all of which lie within p h of the plan's time. Where the
    pace nearby is another, that is only nearly so.
    """
    steps = np.zeros((len(clock) + 1, slope.shape[1]))
    steps[2:-1] = np.abs(np.diff(slope, axis=0))
    total = np.cumsum(steps, axis=0)
    cap = np.ones(len(clock))
    for _ in range(_CLOSER):
        low = np.searchsorted(clock, clock - cap * spacing, side="left")
        high = np.searchsorted(clock, clock + cap * spacing, side="right")
        bend = np.maximum(total[high] - total[low], 1e-12)
        cap = np.minimum(1.0, _least(most[None] * spacing / bend))
    return cap


def _reachable(clock: Floats, cap: Floats, gain: Floats) -> Floats:
    """Highest pace (k,) below `cap`, 0 at both ends, that changes by at most `gain` (k - 1,) /s."""
    squares = (cap**2).tolist()
    squares[0] = squares[-1] = 0.0
    rise = (2.0 * gain * np.diff(clock)).tolist()
    for k, more in enumerate(rise):
        squares[k + 1] = min(squares[k + 1], squares[k] + more)
    for k in range(len(rise) - 1, -1, -1):
        squares[k] = min(squares[k], squares[k + 1] + rise[k])
    return np.asarray(np.sqrt(squares))


def _times(clock: Floats, pace: Floats) -> Floats:
    """When each corner (k,) is reached [s]; between corners the pace changes evenly in time."""
    span = 2.0 * np.diff(clock) / (pace[:-1] + pace[1:])
    return np.concatenate([[0.0], np.cumsum(span)])


def _places(clock: Floats, pace: Floats, time: Floats, spacing: float) -> Floats:
    """Where on the clock (i,) [s] the motion is every `spacing` s, from the start to the end."""
    span = np.diff(time)
    at = spacing * np.arange(math.ceil(time[-1] / spacing - 1e-9) + 1)
    cell = np.clip(np.searchsorted(time, at, side="right") - 1, 0, len(span) - 1)
    since = np.minimum(at - time[cell], span[cell])
    gain = (pace[cell + 1] - pace[cell]) / span[cell]
    places = clock[cell] + since * (pace[cell] + 0.5 * gain * since)
    return np.asarray(np.clip(places, clock[0], clock[-1]))


def _at(clock: Floats, path: Floats, places: Floats) -> Floats:
    return np.stack([np.interp(places, clock, column) for column in path.T], axis=1)


def _too_fast(points: Floats, limits: Limits, spacing: float) -> Flags:
    """Which control points (i,) are too far from the next, or bend too much between both."""
    resting = np.concatenate([points[:1], points, points[-1:]])
    rate = np.diff(resting, axis=0) / spacing
    change = np.abs(np.diff(rate, axis=0)) / spacing
    most = np.minimum(limits.acceleration, limits.jerk * spacing / 2)
    over: Flags = np.any(change > most, axis=1)
    fast: Flags = np.any(np.abs(rate) > limits.speed, axis=1)
    return over | fast[1:] | fast[:-1]


def _strays(
    points: Floats, places: Floats, clock: Floats, path: Floats, tolerance: Floats
) -> Flags:
    """Beside which control points (i,) the spline lies too far from the polyline."""
    c, at = _padded(points), _padded(places[:, None])
    over = np.zeros(len(c) - 3, dtype=bool)
    for u in (0.0, 0.5):
        nearby = _at(clock, path, _value(at, u)[:, 0])
        over |= (np.abs(_value(c, u) - nearby) > tolerance).any(axis=1)
    last = len(points)
    return over[2 : last + 2] | over[1 : last + 1]


def _ease(cap: Floats, clock: Floats, places: Floats, fast: Flags) -> None:
    """Lower the caps between the neighbours of control points that are too fast."""
    where = np.flatnonzero(fast)
    last = len(places) - 1
    low = np.searchsorted(clock, places[np.maximum(where - 1, 0)], side="right") - 1
    high = np.searchsorted(clock, places[np.minimum(where + 1, last)], side="left") + 1
    slower = np.zeros(len(clock) + 2, dtype=int)
    np.add.at(slower, np.maximum(low, 0), 1)
    np.add.at(slower, high, -1)
    cap[np.cumsum(slower)[: len(cap)] > 0] *= _EASE


def _sampled(points: Floats, spacing: float, parts: int) -> Retimed:
    """The spline with control points (i, m), read `parts` times between knots."""
    c = _padded(points)
    a, b, d, e = c[:-3], c[1:-2], c[2:-1], c[3:]
    knots, channels = a.shape
    values, rates, accelerations = (np.empty((knots, parts, channels)) for _ in range(3))
    for k in range(parts):
        u = k / parts
        v = 1.0 - u
        values[:, k] = _value(c, u)
        rates[:, k] = (v * v * (b - a) + (1 + 2 * u * v) * (d - b) + u * u * (e - d)) / 2 / spacing
        accelerations[:, k] = (v * (a - 2 * b + d) + u * (b - 2 * d + e)) / spacing**2
    count = (knots - 1) * parts + 1
    return Retimed(
        np.arange(count) * (spacing / parts),
        *(x.reshape(-1, channels)[:count] for x in (values, rates, accelerations)),
    )


def _padded(points: Floats) -> Floats:
    """Control points with copies of the first and the last: rest at both ends.

    The first knot interval rests too, so that the second sample is one of rest.
    """
    return np.concatenate([np.repeat(points[:1], 3, axis=0), points, np.repeat(points[-1:], 3, 0)])


def _value(c: Floats, u: float) -> Floats:
    """The spline (i - 3, m) at the share `u` of each knot interval."""
    a, b, d, e = c[:-3], c[1:-2], c[2:-1], c[3:]
    # Sums of steps between control points: equal points must give exactly that point.
    across = 1 + 3 * u + 3 * u**2 - 2 * u**3
    return np.asarray(b + ((1 - u) ** 3 * (a - b) + across * (d - b) + u**3 * (e - d)) / 6)


def _least(values: Floats) -> Floats:
    return np.asarray(values.min(axis=1))


def _most(values: Floats) -> Floats:
    return np.asarray(values.max(axis=1))
