"""One lattice problem from start to goal: tables, cells, and the way through them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .cells import FORWARD, MOVES, Cells, World, build_cells, lag_spans, pitch_ranges, wheel_pairs
from .cheapest import cheapest, trace
from .course import Stand, sample_course, scale, stand_height
from .flood import flood
from .lattice import LAG, Finding
from .legs import LEGS_GAP, Leg
from .question import Question
from .tables import (
    Bounds,
    Floats32,
    Lattice,
    LegTable,
    Pulls,
    alike,
    hip_grid,
    on_lattice,
)
from .trunk import trunk_table
from .volumes import Volumes, make_volumes

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]

HipGrid = tuple[Floats32, Floats32, Floats32]

_APART = 0.01  # m; smoothing brings wheels together, and no polish parts them again
_SWEEPS = 12  # most sweeps when wheels may roll back


class Search:
    """A lattice between two stands. Tables are built once; friction and margins may change."""

    def __init__(
        self, q: Question, begin: Stand, end: Stand, lattice: Lattice, bounds: Bounds
    ) -> None:
        path, ground, robot, weights = q.path, q.ground, q.robot, q.weights
        self.path, self.robot, self.lattice, self.bounds = path, robot, lattice, bounds
        self.begin, self.end, self.weights = begin, end, weights
        p = robot.planar
        self.planar = p
        self.legs = q.legs
        size = scale(robot)
        self.s = sample_course(path, begin, end, lattice.step, size)
        self.centres = np.ascontiguousarray(path.centres(self.s))
        self.pulls = Pulls(
            weights.com_margin, weights.clearance, weights.torque, weights.smoothness, weights.pitch
        )
        front, rear = self.legs
        far = 2 * max(leg.reach_max for leg in self.legs) + math.hypot(
            front.hip_x - rear.hip_x, front.hip_z - rear.hip_z
        )
        near = 2 * p.wheel_radius + LEGS_GAP + _APART
        self.pairs = wheel_pairs(
            self.centres, near, far, self._index(begin)[0], self._index(end)[1]
        )
        widest = max(leg.reach_max for leg in self.legs) + 0.2 * (p.thigh + p.calf)
        kept, like = alike(path.vertices, self.centres, widest)
        pitches = pitch_ranges(self.centres, self.pairs, lattice)

        def table(leg: Leg, grid: HipGrid) -> LegTable:
            wanted = pitches[0 if leg is front else 1]
            mass = p.thigh_mass + p.calf_mass + p.wheel_mass
            slack = 0.02 + bounds.thigh
            built: LegTable = on_lattice(
                grid, like, leg, mass, self.centres, wanted, lattice, slack
            )
            return built

        def hips(leg: Leg, samples: Ints) -> HipGrid:
            grid: HipGrid = hip_grid(
                ground, p, leg, self.centres[kept], np.unique(like[samples]), lattice, self.pulls,
                bounds,
            )  # fmt: skip
            return grid

        same = all(
            getattr(front, a) == getattr(rear, a) for a in ("knee", "reach_min", "reach_max")
        )
        if same:
            grid = hips(rear, np.concatenate(self.pairs))
            self.front_table, self.rear_table = table(front, grid), table(rear, grid)
        else:
            self.front_table = table(front, hips(front, self.pairs[0]))
            self.rear_table = table(rear, hips(rear, self.pairs[1]))
        self.ground = ground
        self.trunk = trunk_table(ground, p, lattice, self.pulls, bounds, self.centres, self.pairs)

    def find(
        self,
        friction: float,
        reserve: float,
        com: float,
        cheap: bool = True,
        roll_back: bool = False,
        open_end: bool = False,
        partial: bool = False,
    ) -> Finding:
        """The way from start to goal at `friction`, wide at the `reserve` friction if possible.

        Args:
            friction: Coulomb friction.
            reserve: Lower friction that is kept where the terrain allows it.
            com: Least CoM margin [m].
            cheap: Also trace the smoothest way; otherwise only the verdict is given.
            open_end: Any pose with the front wheels at the last sample will do.
            partial: Where there is no way to the goal, trace the one that gets farthest.
            roll_back: Let wheels roll back where there is no way forward only.
        """
        p, lat = self.planar, self.lattice
        i0, j0 = self._index(self.begin)
        i1, j1 = self._index(self.end)
        cells = build_cells(
            self.path.pieces, self.path.corners, p.wheel_radius, self.s, self.centres, self.pairs,
            lat, friction, reserve, com,
        )  # fmt: skip
        source, goal = int(cells.number[i0, j0]), int(cells.number[i1, j1])
        exits = np.flatnonzero(cells.front == len(self.s) - 1)
        goal = int(exits[0]) if open_end and len(exits) else goal
        if source < 0 or goal < 0:
            return Finding(None, None, 0, None)
        w = self._world(com)
        seed: Ints = self._seed(cells, source, self.begin)
        target: Ints = self._seed(cells, goal, self.end)
        v = make_volumes(len(cells.front), lat)
        moves = FORWARD
        flood(w, cells, v, source, seed, moves)
        if open_end:
            goal = int(exits[int(np.argmax(v.best[exits]))])
            if v.best[goal] > 0:
                target = self._widest(v, goal)
        best, pose = self._best(v, goal, target)
        if best == 0 and roll_back:
            moves = len(MOVES)
            for k in range(_SWEEPS):
                if not flood(w, cells, v, source, seed, moves):
                    break
                best, pose = self._best(v, goal, target)
                if best > 0 and k > 1:
                    break
        reached = None if best > 0 else self._farthest(cells, v)
        if best == 0 and (not partial or reached is None):
            return Finding(None, None, 0, reached)
        if best > 0 and not cheap:
            return Finding(None, None, best, None, moves > FORWARD)
        if best == 0:
            goal = int(cells.number[self._index(Stand(reached or (0.0, 0.0), self.end.body))])
            pose = self._widest(v, goal)
        wide = best or int(v.best[goal])
        level = max(1, min(wide, 150) if wide > 100 else int(0.7 * wide))
        pulls = np.array(
            [
                self.weights.com_margin,
                self.weights.pitch,
                stand_height(self.robot),
                0.09 * scale(self.robot),
            ]
        )
        smooth = 0.25 * self.weights.smoothness
        lag_spans(
            cells, v.best >= level, self.path.pieces, self.path.corners, p.wheel_radius, self.s,
            friction, LAG,
        )  # fmt: skip
        for _ in range(1 if moves == FORWARD else 2 * _SWEEPS):
            if not cheapest(w, cells, v, source, seed, moves, smooth, pulls, level):
                break
        rows = np.empty((4 * len(self.s) + 400, 5), np.int32)
        last = self._cheapest_pose(self._window(v.value[v.slot[goal]]), pose)
        count = trace(w, cells, v, source, goal, last, moves, smooth, rows)
        if count < 0:
            return Finding(None, None, 0, self._farthest(cells, v))
        rows = rows[:count][::-1]
        s = np.stack([self.s[rows[:, 0]], self.s[rows[:, 1]]], axis=1)
        body = np.stack(
            [rows[:, 4] * lat.step, rows[:, 3] * lat.step, rows[:, 2] * lat.turn], axis=1
        )
        return Finding(s, body, best, (float(s[-1, 0]), float(s[-1, 1])), moves > FORWARD)

    def _world(self, com: float) -> World:
        return World(
            self.ground, self.planar, *self.legs, self.centres, self.s, self.lattice,
            self.front_table, self.rear_table, self.trunk,
            self.bounds.legs, com,
        )  # fmt: skip

    def _index(self, where: Stand) -> tuple[int, int]:
        return (
            int(np.argmin(np.abs(self.s - where.wheels[0]))),
            int(np.argmin(np.abs(self.s - where.wheels[1]))),
        )

    def _seed(self, cells: Cells, c: int, where: Stand) -> Ints:
        lat, body = self.lattice, where.body
        seed = [
            round(body[2] / lat.turn) + lat.pitches // 2 - cells.t0[c],
            round(body[1] / lat.step) - cells.z0[c],
            round(body[0] / lat.step) - cells.x0[c],
        ]
        sizes = (lat.nt, lat.nz, lat.nx)
        return np.array(
            [min(max(int(v), 0), n - 1) for v, n in zip(seed, sizes, strict=True)], np.int32
        )

    def _window(self, volume: NDArray[Any]) -> NDArray[Any]:
        """(nt, nz, nx) view of a flat volume without its rim."""
        lat = self.lattice
        full = volume.reshape(lat.nt + 4, lat.nz + 4, lat.row)
        return full[2:-2, 2:-2, 2 : 2 + lat.nx]

    @staticmethod
    def _near(pose: Ints) -> tuple[slice, ...]:
        return tuple(slice(max(0, int(v) - 2), int(v) + 3) for v in pose)

    def _best(self, v: Volumes, goal: int, target: Ints) -> tuple[int, Ints]:
        """Best quality near the resting pose `target` at the goal, and that pose."""
        if v.best[goal] == 0:
            return 0, target
        part = self._near(target)
        near = self._window(v.width[v.slot[goal]])[part]
        if near.size == 0 or near.max() == 0:
            return 0, target
        at = np.unravel_index(int(near.argmax()), near.shape)
        pose = [int(k) + part[m].start for m, k in enumerate(at)]
        return int(near.max()), np.array(pose, np.int32)

    def _widest(self, v: Volumes, c: int) -> Ints:
        """The pose of cell `c` with the widest way to it."""
        inside = self._window(v.width[v.slot[c]])
        at = np.unravel_index(int(inside.argmax()), inside.shape)
        return np.array([int(k) for k in at], np.int32)

    def _cheapest_pose(self, volume: NDArray[np.float32], pose: Ints) -> Ints:
        part = self._near(pose)
        at = np.unravel_index(int(volume[part].argmin()), volume[part].shape)
        return np.array([int(k) + part[m].start for m, k in enumerate(at)], np.int32)

    def _farthest(self, cells: Cells, v: Volumes) -> tuple[float, float] | None:
        found = np.flatnonzero(v.best)
        if len(found) == 0:
            return None
        sums = self.s[cells.front[found]] + self.s[cells.rear[found]]
        c = found[int(np.argmax(sums))]
        return float(self.s[cells.front[c]]), float(self.s[cells.rear[c]])
