"""What every node of a path is worth: joints, margins, forces and torques."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.robot.description import Planar, Robot
from stairwright.statics.contact import GRAVITY, com_interval, least_friction
from stairwright.statics.margin import com_margin, friction_needed, leg_torques
from stairwright.terrain.wheel_path import WheelPath, curve_at

from .contacts import firm_margins, wheel_contacts
from .ground import Ground
from .legs import COM_X, LEGS, LEGS_GAP, LINKS, RECORD, SLACK, TRUNK, Leg, evaluate

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Motor = Literal["leg", "wheel"]

LEAST_CLEARANCE = 0.0005  # m; the best controller strays that far
LEAST_COM = 0.001  # m; no robot's centre of mass is known better
# Where the CoM has less room than this [m], that share of the friction must be left: else a wheel
# that slides a little tips the robot.
THIN_COM, FIRM_GRIP = 0.006, 0.08
_SPARE = 5e-4  # m


@dataclass(frozen=True)
class Record:
    """Arrays over the nodes of a path. SI units.

    Attributes:
        poses: (n, RECORD) see `legs.evaluate`.
        com: (n,) CoM margin at the friction there is.
        firm: (n,) the same with friction on one face of a corner only, which robots can hold.
        need: (n,) friction needed.
        forces: (n, 2, 2) force of each wheel pair, tangential and normal [N]; a wheel between two
            faces counts them along the bisector of the faces that carry it.
        torque: (n,) largest static leg joint torque [Nm].
        wheel_torque: (n,) largest static wheel torque [Nm].
        friction, leg_limit, wheel_limit: What there is.
    """

    poses: Floats
    com: Floats
    firm: Floats
    need: Floats
    forces: Floats
    torque: Floats
    wheel_torque: Floats
    friction: float
    leg_limit: float
    wheel_limit: float

    def part(self, begin: int, end: int) -> Record:
        """The record of the nodes [begin, end)."""
        return replace(self, **{name: getattr(self, name)[begin:end] for name in _OF_NODES})

    @property
    def clearance(self) -> Floats:
        """(n,) least distance of trunk and links from the terrain [m]."""
        return np.minimum(self.poses[:, TRUNK], self.poses[:, LINKS])

    @cached_property
    def _rooms(self) -> Floats:
        """(7, n) margins, each against its bound, in comparable sizes."""
        margins: Floats = np.stack(
            [
                self.clearance - LEAST_CLEARANCE,
                self.poses[:, LEGS] - LEGS_GAP,
                0.2 * self.poses[:, SLACK],
                self.firm - LEAST_COM,
                np.maximum(
                    self.firm - THIN_COM, 0.2 * ((1.0 - FIRM_GRIP) * self.friction - self.need)
                ),
                (self.wheel_limit - self.wheel_torque) * 0.01,
                (self.leg_limit - self.torque) * 0.01,
            ]
        )
        return margins

    @property
    def room(self) -> Floats:
        """(n,) least of all margins."""
        least: Floats = self._rooms.min(axis=0)
        return least

    @property
    def weak(self) -> Motor | None:
        """The motors whose torque is the one bound that is violated."""
        broken = np.flatnonzero(self._rooms.min(axis=1) < 0.0) - len(self._rooms)
        return _LAST_ROOMS.get(int(broken[0])) if len(broken) == 1 else None

    @property
    def worst(self) -> float:
        """Least of all margins on the path; negative: a bound is violated."""
        return float(self.room.min())

    @property
    def bad(self) -> Ints:
        """Nodes where a bound is violated, or kept with next to nothing to spare."""
        return np.flatnonzero(self.room < _SPARE)


_LAST_ROOMS: dict[int, Motor] = {-2: "wheel", -1: "leg"}
_OF_NODES = ("poses", "com", "firm", "need", "forces", "torque", "wheel_torque")


def joined(records: Sequence[Record]) -> Record:
    """One record after the other."""
    nodes: dict[str, Any] = {
        name: np.concatenate([getattr(one, name) for one in records]) for name in _OF_NODES
    }
    return replace(records[0], **nodes)


@nb.njit(cache=True)
def _with_bisector(
    at: Floats,
    normals: Floats,
    begin: int,
    count: int,
    x: float,
    z: float,
    r: float,
    points: Floats,
    out: Floats,
) -> int:
    """Copy a wheel's contacts to `points`, `out` and add their bisector; returns the number."""
    for k in range(count):
        points[k], out[k] = at[begin + k], normals[begin + k]
    if count < 2:
        return count
    nx, nz = out[0, 0] + out[1, 0], out[0, 1] + out[1, 1]
    norm = np.hypot(nx, nz)
    if norm < 0.2:  # opposite walls: no direction between them
        return count
    out[2, 0], out[2, 1] = nx / norm, nz / norm
    points[2, 0], points[2, 1] = x - r * nx / norm, z - r * nz / norm
    return 3


@nb.njit(cache=True, nogil=True)
def _evaluate_path(
    pieces: Floats,
    corners: Floats,
    g: Ground,
    p: Planar,
    front: Leg,
    rear: Leg,
    s: Floats,
    body: Floats,
    friction: float,
    look: float,
) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
    n = len(s)
    r = p.wheel_radius
    poses, com, need = np.empty((n, RECORD)), np.empty(n), np.empty(n)
    forces, torque, wheel_torque = np.zeros((n, 2, 2)), np.empty(n), np.empty(n)
    points, wheels = np.empty((2, 3, 2)), np.empty(4)
    at, normals = np.empty((4, 2)), np.empty((4, 2))
    pair_at, pair_n, pair_f = np.empty((2, 2)), np.empty((2, 2)), np.empty((2, 2))
    kept = np.zeros((2, 2))
    faces, face_n = np.zeros((6, 2)), np.zeros((6, 2))
    weight = p.mass * GRAVITY
    for k in range(n):
        for m in range(2):
            wheels[2 * m], wheels[2 * m + 1], _, _ = curve_at(pieces, r, s[k, m])
        evaluate(g, p, front, rear, body[k], wheels, look, points, poses[k])
        x = poses[k, COM_X]
        a = wheel_contacts(pieces, corners, r, s[k, 0], at, normals, 0)
        b = wheel_contacts(pieces, corners, r, s[k, 1], at, normals, a)
        low, high = com_interval(at, normals, a + b, friction)
        com[k] = com_margin(low, high, x)
        need[k] = friction_needed(at, normals, a + b, x)
        # A wheel between two faces may lean on either or on both: their bisector stands for both,
        # with a cone that is narrower than the true one.
        a2 = _with_bisector(at, normals, 0, a, wheels[0], wheels[1], r, faces, face_n)
        b2 = _with_bisector(at, normals, a, b, wheels[2], wheels[3], r, faces[3:], face_n[3:])
        least = np.inf
        for stage in range(2):
            # Wheels that pinch a curb between them press hard at low friction: use more of it.
            if stage == 1 and least < 1.6:
                break
            ample = (0.75 if stage == 0 else 0.98) * friction
            for i in range(a2 - 1, -1, -1):
                for j in range(b2 - 1, -1, -1):
                    pair_at[0], pair_at[1] = faces[i], faces[3 + j]
                    pair_n[0], pair_n[1] = face_n[i], face_n[3 + j]
                    mu = least_friction(pair_at, pair_n, x, ample, pair_f)
                    score = pair_f[0, 1] + pair_f[1, 1] if mu <= ample else 100.0 + mu
                    if score < least - 1e-9:
                        least = score
                        kept[:] = pair_f
                        ni, nj = i, 3 + j
        if least < np.inf:
            forces[k] = kept * weight
        elif k > 0:
            forces[k] = forces[k - 1]
            ni, nj = 0, 3
        else:
            forces[k, 0, 1] = forces[k, 1, 1] = 0.5 * weight
            ni, nj = 0, 3
        torque[k] = 0.0
        wheel_torque[k] = 0.0
        for m in range(2):
            nx, nz = (face_n[ni, 0], face_n[ni, 1]) if m == 0 else (face_n[nj, 0], face_n[nj, 1])
            t, f = forces[k, m, 0], forces[k, m, 1]
            fx, fz = t * nz + f * nx, -t * nx + f * nz
            touch = faces[ni] if m == 0 else faces[nj]
            thigh, calf = leg_torques(p, points[m, 0], points[m, 1], points[m, 2], touch, fx, fz)
            torque[k] = max(torque[k], thigh, calf)
            wheel_torque[k] = max(wheel_torque[k], 0.5 * abs(t) * r)
    return poses, com, need, forces, torque, wheel_torque


def evaluate_path(
    path: WheelPath,
    ground: Ground,
    robot: Robot,
    legs: tuple[Leg, Leg],
    s: Floats,
    body: Floats,
    friction: float,
) -> Record:
    """Judge the nodes `s` (n, 2), `body` (n, 3) of a path exactly."""
    p = robot.planar
    poses, com, need, forces, torque, wheel_torque = _evaluate_path(
        path.pieces, path.corners, ground, p, *legs, s, body, friction, 0.3
    )
    x = np.ascontiguousarray(poses[:, COM_X])
    firm = firm_margins(path.pieces, path.corners, path.radius, s, x, friction)
    return Record(
        poses, com, firm, need, forces, torque, wheel_torque, friction, p.leg_torque, p.wheel_torque
    )  # fmt: skip
