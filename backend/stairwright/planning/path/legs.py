"""Compiled closed-form kinematics of one pose, and everything that a pose is judged by."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.compiled import leaf
from stairwright.robot.description import Planar

from .ground import Ground, box_clearance, link_clearance, point_segment, segment_gap

Floats = NDArray[np.float64]


LEGS_GAP = 0.005  # m; front and rear leg stay this far apart


class Leg(NamedTuple):
    """One leg pair: hip in the trunk frame, knee side, joint ranges.

    The calf's range is also given as the distance from hip to wheel centre that it allows.
    """

    hip_x: float
    hip_z: float
    knee: float
    thigh_min: float
    thigh_max: float
    reach_min: float
    reach_max: float
    calf_min: float
    calf_max: float


@lru_cache(maxsize=64)
def make_legs(p: Planar) -> tuple[Leg, Leg]:
    """Front and rear leg of a robot."""

    def leg(hip_x: float, hip_z: float, knee: float, limits: tuple[float, ...]) -> Leg:
        thigh_min, thigh_max, calf_min, calf_max = limits
        other = (p.hip_rear_x, p.hip_rear_z)
        if (hip_x, hip_z) == other:
            other = (p.hip_front_x, p.hip_front_z)
        thigh_min, thigh_max = _past_hip(
            p, other[0] - hip_x, other[1] - hip_z, thigh_min, thigh_max
        )
        bends = sorted((abs(calf_min), abs(calf_max)))
        near, far = (
            math.sqrt(max(0.0, p.thigh**2 + p.calf**2 + 2 * p.thigh * p.calf * math.cos(bend)))
            for bend in (min(bends[1], math.pi), min(bends[0], math.pi))
        )
        return Leg(hip_x, hip_z, knee, thigh_min, thigh_max, near, far, calf_min, calf_max)

    return (
        leg(
            p.hip_front_x,
            p.hip_front_z,
            p.knee_front,
            (p.thigh_front_min, p.thigh_front_max, p.calf_front_min, p.calf_front_max),
        ),
        leg(
            p.hip_rear_x,
            p.hip_rear_z,
            p.knee_rear,
            (p.thigh_rear_min, p.thigh_rear_max, p.calf_rear_min, p.calf_rear_max),
        ),
    )


def farthest_apart(legs: tuple[Leg, Leg]) -> float:
    """Distance of the wheels' centres that no pose of the trunk exceeds [m]."""
    front, rear = legs
    hips = math.hypot(front.hip_x - rear.hip_x, front.hip_z - rear.hip_z)
    return 2 * max(leg.reach_max for leg in legs) + hips


def _past_hip(p: Planar, dx: float, dz: float, low: float, high: float) -> tuple[float, float]:
    """The part of a thigh's range, with the leg straight down, that the other hip leaves it.

    A thigh that is longer than the hips are apart cannot swing past the other leg's hip, which lies
    at (dx, dz) from its own. A lattice would step over that.
    """
    apart, room = math.hypot(dx, dz), 2.0 * p.thigh_radius + LEGS_GAP
    if apart <= room or apart >= p.thigh + room:
        return low, high
    towards, half = math.atan2(-dx, -dz), math.asin(room / apart)
    for turn in (-2.0 * math.pi, 0.0, 2.0 * math.pi):
        a, b = towards + turn - half, towards + turn + half
        if a > 0.0 and low <= 0.0:
            high = min(high, a)
        elif b < 0.0 and high >= 0.0:
            low = max(low, b)
    return low, high


@nb.njit(cache=True)
def knee_point(dx: float, dz: float, thigh: float, calf: float, side: float) -> tuple[float, float]:
    """Knee relative to the hip for a wheel at (dx, dz) from it; the reach is clamped."""
    d = max(math.hypot(dx, dz), 1e-9)
    ex, ez = dx / d, dz / d
    a = (thigh * thigh - calf * calf + d * d) / (2.0 * d)
    a = min(thigh, max(-thigh, a))
    h = math.sqrt(max(0.0, thigh * thigh - a * a))
    return a * ex - side * h * ez, a * ez + side * h * ex


@nb.njit(cache=True)
def thigh_joint(kx: float, kz: float, pitch: float, leg: Leg) -> float:
    """Thigh joint angle for a knee at (kx, kz) from the hip, nearest to the middle of its range."""
    middle = 0.5 * (leg.thigh_min + leg.thigh_max)
    turn = math.atan2(-kx, -kz) - pitch - middle
    return middle + turn - 2 * math.pi * math.floor((turn + math.pi) / (2 * math.pi))


@nb.njit(cache=True)
def calf_joint(dx: float, dz: float, thigh: float, calf: float, side: float) -> float:
    """Calf joint angle for a wheel at (dx, dz) from the hip; the reach is clamped."""
    c = (dx * dx + dz * dz - thigh * thigh - calf * calf) / (2.0 * thigh * calf)
    return side * math.acos(min(1.0, max(-1.0, c)))


@leaf
def legs_gap(p: Planar, points: Floats) -> float:
    """Distance of two legs in one plane [m]: thighs, calves, wheels; negative if they touch.

    `points` are (2, 3, 2): hip, knee, wheel centre of either.
    """
    a, b = points[0], points[1]
    rt, rc, rw = p.thigh_radius, p.calf_radius, p.wheel_radius
    best = math.hypot(a[2, 0] - b[2, 0], a[2, 1] - b[2, 1]) - 2.0 * rw
    for i in range(2):
        ri = rt if i == 0 else rc
        for j in range(2):
            rj = rt if j == 0 else rc
            gap = segment_gap(
                a[i, 0], a[i, 1], a[i + 1, 0], a[i + 1, 1],
                b[j, 0], b[j, 1], b[j + 1, 0], b[j + 1, 1],
            )  # fmt: skip
            best = min(best, gap - ri - rj)
        to_b = point_segment(b[2, 0], b[2, 1], a[i, 0], a[i, 1], a[i + 1, 0], a[i + 1, 1])
        to_a = point_segment(a[2, 0], a[2, 1], b[i, 0], b[i, 1], b[i + 1, 0], b[i + 1, 1])
        best = min(best, math.sqrt(min(to_a, to_b)) - ri - rw)
    return best


# Columns of a pose's record.
Q0, COM_X, COM_Z, TRUNK, LINKS, LEGS, SLACK, REACH = 0, 4, 5, 6, 7, 8, 9, 10
RECORD = 11


@leaf
def posture(
    p: Planar, front: Leg, rear: Leg, body: Floats, wheels: Floats, points: Floats, out: Floats
) -> None:
    """Fill `points` and what of a record needs neither ground nor joint angles: CoM, reach."""
    c, s = math.cos(body[2]), math.sin(body[2])
    mx, mz = p.trunk_mass * body[0], p.trunk_mass * body[1]
    out[REACH] = np.inf
    for k in range(2):
        leg = front if k == 0 else rear
        hx = body[0] + c * leg.hip_x + s * leg.hip_z
        hz = body[1] - s * leg.hip_x + c * leg.hip_z
        wx, wz = wheels[2 * k], wheels[2 * k + 1]
        kx, kz = knee_point(wx - hx, wz - hz, p.thigh, p.calf, leg.knee)
        kx, kz = kx + hx, kz + hz
        points[k, 0, 0], points[k, 0, 1] = hx, hz
        points[k, 1, 0], points[k, 1, 1] = kx, kz
        points[k, 2, 0], points[k, 2, 1] = wx, wz
        mx += p.thigh_mass * (hx + p.thigh_com * (kx - hx)) + p.wheel_mass * wx
        mx += p.calf_mass * (kx + p.calf_com * (wx - kx))
        mz += p.thigh_mass * (hz + p.thigh_com * (kz - hz)) + p.wheel_mass * wz
        mz += p.calf_mass * (kz + p.calf_com * (wz - kz))
        d = math.hypot(wx - hx, wz - hz)
        out[REACH] = min(out[REACH], min(d - leg.reach_min, leg.reach_max - d))
    out[COM_X], out[COM_Z] = mx / p.mass, mz / p.mass


@leaf
def joints(p: Planar, front: Leg, rear: Leg, pitch: float, points: Floats, out: Floats) -> None:
    """Fill joint angles and their least slack, from the `points` of `posture`."""
    out[SLACK] = np.inf
    for k in range(2):
        leg = front if k == 0 else rear
        (hx, hz), (kx, kz), (wx, wz) = points[k, 0], points[k, 1], points[k, 2]
        q1 = thigh_joint(kx - hx, kz - hz, pitch, leg)
        q2 = calf_joint(wx - hx, wz - hz, p.thigh, p.calf, leg.knee)
        out[Q0 + 2 * k], out[Q0 + 2 * k + 1] = q1, q2
        slack = min(q1 - leg.thigh_min, leg.thigh_max - q1)
        slack = min(slack, min(q2 - leg.calf_min, leg.calf_max - q2))
        out[SLACK] = min(out[SLACK], slack)


@leaf
def trunk_gap(g: Ground, p: Planar, body: Floats, look: float) -> float:
    """Clearance of the trunk [m]."""
    c, s = math.cos(body[2]), math.sin(body[2])
    return float(box_clearance(g, body[0], body[1], c, s, p.half_length, p.half_height, look))


@leaf
def links_gap(g: Ground, p: Planar, points: Floats, look: float) -> float:
    """Least clearance of thighs and calves, from the `points` of `posture` [m]."""
    least = look
    for k in range(2):
        (hx, hz), (kx, kz), (wx, wz) = points[k, 0], points[k, 1], points[k, 2]
        thigh = link_clearance(g, hx, hz, kx, kz, p.thigh_radius, look)
        calf = link_clearance(g, kx, kz, wx, wz, p.calf_radius, look)
        least = min(least, min(thigh, calf))
    return least


@leaf
def evaluate(
    g: Ground,
    p: Planar,
    front: Leg,
    rear: Leg,
    body: Floats,
    wheels: Floats,
    look: float,
    points: Floats,
    out: Floats,
) -> None:
    """Fill the record `out` (RECORD,) of one pose.

    Joints (4), CoM x and z, clearance of the trunk and of the four links, gap between the legs,
    least slack of the joint limits [rad], least slack of the hip-wheel distances [m].

    Args:
        g, p, front, rear: Terrain and robot.
        body: (3,) trunk x, z, pitch.
        wheels: (4,) front and rear wheel centre.
        look: Clearances beyond this distance are not told apart [m].
        points: (2, 3, 2) filled with hip, knee, wheel of the front and the rear leg.
        out: The record.
    """
    posture(p, front, rear, body, wheels, points, out)
    joints(p, front, rear, body[2], points, out)
    out[TRUNK] = trunk_gap(g, p, body, look)
    out[LINKS] = links_gap(g, p, points, look)
    out[LEGS] = legs_gap(p, points)
