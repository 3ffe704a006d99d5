"""One lattice problem from start to goal: tables, cells, and the way through them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stairwright.planning.threads import still_wanted

from .cells import (
    FORWARD,
    MOVES,
    Cells,
    World,
    build_cells,
    lag_spans,
    pitch_ranges,
    wheel_pairs,
)
from .cheapest import cheapest, trace
from .course import Stand, sample_course, scale, stand_height
from .ends import anywhere, arrival, cheapest_pose, near, pose_in, widest_pose
from .flood import flood
from .lattice import Finding
from .legs import LEGS_GAP, Leg, farthest_apart
from .question import LAG, Question
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
from .volumes import Volumes, leading_to, make_costs, make_volumes

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Longs = NDArray[np.int64]
Place = tuple[float, float]  # arc lengths of front and rear wheel [m]
Flags = NDArray[np.bool_]

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
        close = 2 * p.wheel_radius + LEGS_GAP + _APART
        far, ends = farthest_apart(self.legs), (self._index(begin)[0], self._index(end)[1])
        self.pairs = wheel_pairs(self.centres, close, far, *ends)
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
        still_wanted()
        self.trunk = trunk_table(ground, p, lattice, self.pulls, bounds, self.centres, self.pairs)

    def find(
        self,
        friction: float,
        reserve: float,
        com: float,
        cheap: bool = True,
        roll_back: bool = False,
        open_start: bool = False,
        open_end: bool = False,
        partial: bool = False,
    ) -> Finding:
        """The way from start to goal at `friction`, wide at the `reserve` friction if possible.

        Args:
            friction: Coulomb friction.
            reserve: Lower friction that is kept where the terrain allows it.
            com: Least CoM margin [m].
            cheap: Also trace the smoothest way; otherwise only the verdict is given, without regard
                to the reserve.
            roll_back: Let wheels roll back where there is no way forward only.
            open_start: Any pose with the rear wheels at the first sample will do; not with `cheap`.
            open_end: Any pose with the front wheels at the last sample will do.
            partial: Where there is no way to the goal, trace the one that gets farthest.
        """
        lat = self.lattice
        cells = self._cells(friction, reserve if cheap or partial else 0.0, com)
        entries = cells.rear == 0 if open_start else self._only(cells, self.begin)
        goals, target = self._goals(cells, open_end)
        if not entries.any() or not len(goals):
            return Finding(None, None, 0, None)
        still_wanted()
        w = self._world(com)
        source = int(np.argmax(entries))
        seed = pose_in(lat, cells, source, self.begin)
        first = anywhere(lat) if open_start else near(lat, seed)
        v = make_volumes(len(cells.front), lat)
        moves = FORWARD
        flood(w, cells, v, entries, first, moves)
        best, goal, pose = arrival(lat, v, goals, target)
        if best == 0 and roll_back:
            moves = len(MOVES)
            v.sweeps.seen.fill(-1)  # none has been looked at for ways back
            for k in range(_SWEEPS):
                if not flood(w, cells, v, entries, first, moves):
                    break
                best, goal, pose = arrival(lat, v, goals, target)
                if best > 0 and k > 1:
                    break
        reached = None if best > 0 else self._farthest(cells, v)
        if best == 0 and (not partial or reached is None):
            return Finding(None, None, 0, reached)
        if best > 0 and not cheap:
            return Finding(None, None, best, None, moves > FORWARD)
        if best == 0:
            goal = int(cells.number[self._index(Stand(reached or (0.0, 0.0), self.end.body))])
            pose = widest_pose(lat, v, goal)
        still_wanted()
        wide = best or int(v.best[goal])
        level = max(1, min(wide, 150) if wide > 100 else int(0.7 * wide))
        wanted = leading_to(cells, v, level, goal, moves)
        lag_spans(
            cells, wanted, self.path.pieces, self.path.corners, self.planar.wheel_radius,
            self.s, friction, LAG,
        )  # fmt: skip
        rows = self._smoothest(w, cells, v, source, seed, goal, pose, moves, level, wanted)
        if rows is None:
            return Finding(None, None, 0, self._farthest(cells, v))
        s = np.stack([self.s[rows[:, 0]], self.s[rows[:, 1]]], axis=1)
        body = np.stack(
            [rows[:, 4] * lat.step, rows[:, 3] * lat.step, rows[:, 2] * lat.turn], axis=1
        )
        return Finding(s, body, best, (float(s[-1, 0]), float(s[-1, 1])), moves > FORWARD)

    def stops(self, friction: float, com: float, open_end: bool) -> list[Place]:
        """Where ways end that begin at any pose with the rear wheels at the first sample, and so on
        from where the front wheels ended; see `find`.

        Returns:
            Arc lengths of front and rear wheel, in order; empty where a way leads to the end.
        """
        cells, w = self._cells(friction, 0.0, com), self._world(com)
        goals, target = self._goals(cells, open_end)
        out: list[Place] = []
        row = 0
        while len(goals) and row <= cells.rear[goals].max():
            v = make_volumes(len(cells.front), self.lattice)
            flood(w, cells, v, cells.rear == row, anywhere(self.lattice), FORWARD)
            end = self._farthest(cells, v)
            if end is None:
                row += 1
                continue
            if arrival(self.lattice, v, goals, target)[0] > 0:
                break
            out.append(end)
            row = self._index(Stand(end, self.end.body))[0]
        return out

    def _goals(self, cells: Cells, open_end: bool) -> tuple[Longs, Ints | None]:
        """Cells in which ways end, and their pose unless any will do."""
        if open_end:
            return np.flatnonzero(cells.front == len(self.s) - 1), None
        goals = np.flatnonzero(self._only(cells, self.end))
        if not len(goals):
            return goals, None
        return goals, pose_in(self.lattice, cells, int(goals[0]), self.end)

    def _cells(self, friction: float, reserve: float, com: float) -> Cells:
        return build_cells(
            self.path.pieces, self.path.corners, self.planar.wheel_radius, self.s, self.centres,
            self.pairs, self.lattice, friction, reserve, com,
        )  # fmt: skip

    def _smoothest(
        self, w: World, cells: Cells, v: Volumes, source: int, seed: Ints, goal: int, pose: Ints,
        moves: int, level: int, wanted: Flags,
    ) -> Ints | None:  # fmt: skip
        """Cheapest way at least `level` wide from cell `source` to `goal` through `wanted` cells.

        See `cheapest`, `trace`.

        Returns:
            (n, 5) its front and rear samples and lattice poses (pitch, z, x), if it ends.
        """
        height, wish = stand_height(self.robot), 0.09 * scale(self.robot)
        pulls = np.array([self.weights.com_margin, self.weights.pitch, height, wish])
        smooth = 0.25 * self.weights.smoothness
        costs = make_costs(v, level, wanted)
        for _ in range(1 if moves == FORWARD else 2 * _SWEEPS):
            if not cheapest(w, cells, v, costs, source, seed, moves, smooth, pulls, level):
                break
        rows = np.empty((4 * len(self.s) + 400, 5), np.int32)
        last = cheapest_pose(self.lattice, costs, goal, pose)
        count = trace(w, cells, costs, source, goal, last, moves, smooth, rows)
        return rows[:count][::-1] if count >= 0 else None

    def _world(self, com: float) -> World:
        return World(
            self.ground, self.planar, *self.legs, self.centres, self.s, self.lattice,
            self.front_table, self.rear_table, self.trunk,
            self.bounds.legs, com,
        )  # fmt: skip

    def _only(self, cells: Cells, where: Stand) -> Flags:
        """Flags (n,) of the one cell of the stand `where`, if it has one."""
        out: Flags = np.zeros(len(cells.front), np.bool_)
        c = int(cells.number[self._index(where)])
        if c >= 0:
            out[c] = True
        return out

    def _index(self, where: Stand) -> tuple[int, int]:
        return (
            int(np.argmin(np.abs(self.s - where.wheels[0]))),
            int(np.argmin(np.abs(self.s - where.wheels[1]))),
        )

    def _farthest(self, cells: Cells, v: Volumes) -> Place | None:
        """The pair of places farthest along that was reached."""
        found = np.flatnonzero(v.best)
        if len(found) == 0:
            return None
        sums = self.s[cells.front[found]] + self.s[cells.rear[found]]
        c = found[int(np.argmax(sums))]
        return float(self.s[cells.front[c]]), float(self.s[cells.rear[c]])
