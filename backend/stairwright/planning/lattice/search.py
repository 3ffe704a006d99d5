"""One lattice problem from start to goal: tables, cells, and the path through them."""

from __future__ import annotations

import numpy as np

from stairwright import _core
from stairwright.arrays import Flags, Ints, Ints32
from stairwright.planning.lattice.body_lattice import Bounds, Lattice, LatticePath
from stairwright.planning.lattice.cells import ALL_MOVES, FORWARD, Cells, alike
from stairwright.planning.lattice.ends import anywhere, arrival, near, pose_in, widest_pose
from stairwright.planning.path_problem import LAG, PathProblem
from stairwright.planning.standing import StandingPose, scale, standing_height
from stairwright.planning.threads import still_wanted
from stairwright.planning.weights import PathWeights
from stairwright.planning.wheel_samples import sample_wheel_places

Place = tuple[float, float]  # arc lengths of front and rear wheel [m]

_APART = 0.01  # m; smoothing brings wheels together, and no smoothing parts them again
_SWEEPS = 12  # most sweeps when wheels may roll back


class Search:
    """A lattice between two stands. Tables are built once; friction and margins may change."""

    def __init__(
        self,
        q: PathProblem,
        begin: StandingPose,
        end: StandingPose,
        lattice: Lattice,
        bounds: Bounds,
        brinks: bool = False,
    ) -> None:
        path, robot, model = q.path, q.robot, q.robot_model
        self.path, self.robot, self.lattice = path, robot, lattice
        self.bounds = q.extra.within(bounds, q.in_search)
        self.begin, self.end, self.weights, self.model = begin, end, q.weights, model
        self.s = sample_wheel_places(path, begin, end, lattice.step, scale(robot), brinks)
        self.centres = path.centres(self.s)
        close = 2 * path.radius + _core.LEGS_GAP + _APART + q.extra.legs
        ends = (self._index(begin)[0], self._index(end)[1])
        self.pairs = _core.sample_pairs(self.centres, close, model.most_wheel_distance, *ends)
        still_wanted()
        costs = _core.TableWeights(q.weights.clearance, q.weights.torque)
        self.legs = self._leg_tables(q.ground, costs)
        still_wanted()
        self.trunk = _core.lattice_trunk_table(
            *_core.trunk_table(
                q.ground, model, lattice.windows, costs, self.bounds.trunk, self.centres, self.pairs
            )
        )

    def _leg_tables(
        self, ground: _core.Terrain, costs: _core.TableWeights
    ) -> tuple[_core.LatticeLegTable, _core.LatticeLegTable]:
        """What front and rear leg cost; samples with the same ground around share a hip grid."""
        lattice, model = self.lattice, self.model
        links = max(leg.reach for leg in self.robot.legs)
        widest = max(most for _, most in model.reach) + 0.2 * links
        kept, like = alike(self.path.vertices, self.centres, widest)
        pitches = _core.pitch_ranges(self.centres, self.pairs, lattice.windows)

        def grid(pair: int, samples: Ints32) -> _core.HipGrid:
            wanted = np.unique(like[samples])
            return _core.hip_grid(
                ground, model, pair, self.centres[kept], wanted, lattice.step, lattice.half,
                costs, self.bounds.tolerances,
            )  # fmt: skip

        if model.legs_alike:
            grids = [grid(0, self.pairs.ravel())] * 2
        else:
            grids = [grid(pair, self.pairs[:, pair]) for pair in range(2)]
        slack = 0.02 + self.bounds.thigh

        def table(pair: int) -> _core.LatticeLegTable:
            columns = _core.leg_table(
                grids[pair], model, pair, like, self.centres, pitches[pair], lattice.native, slack
            )
            return _core.lattice_leg_table(**columns)

        return table(0), table(1)

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
        torque: float | None = None,
        weights: PathWeights | None = None,
    ) -> LatticePath:
        """The path from start to goal at `friction`, wide at the `reserve` friction if possible.

        Args:
            friction: Coulomb friction.
            reserve: Lower friction that is kept where the terrain allows it.
            com: Least CoM margin [m].
            cheap: Also trace the smoothest path; otherwise only the verdict is given, without
                regard to the reserve.
            roll_back: Let wheels roll back where no path rolls forward only.
            open_start: Any pose with the rear wheels at the first sample will do; not with `cheap`.
            open_end: Any pose with the front wheels at the last sample will do.
            partial: Where there is no path to the goal, trace the one that gets farthest.
            torque: Largest share of the motors' torques that a pose may take; any by default.
            weights: What the smoothest path trades off, those of the question by default; clearance
                and torque are weighed in tables and stay as they are.
        """
        lat = self.lattice
        cells = self._cells(friction, reserve if cheap or partial else 0.0, com)
        entries = cells.rear == 0 if open_start else self._only(cells, self.begin)
        goals, target = self._goals(cells, open_end)
        if not entries.any() or not len(goals):
            return LatticePath(None, None, 0, None)
        still_wanted()
        problem = self._problem(com)
        source = int(np.argmax(entries))
        seed = pose_in(lat, cells, source, self.begin)
        first = anywhere(lat) if open_start else near(lat, seed)
        windows = _windows(problem, cells)
        widest = self._widest(problem, windows, cells, friction, torque)
        moves = FORWARD
        widest.sweep(entries, first, moves)
        best, goal, pose = arrival(lat, widest, goals, target)
        if best == 0 and roll_back:
            moves = ALL_MOVES
            widest.look_everywhere()  # no cell has been looked at for ways back
            for k in range(_SWEEPS):
                if not widest.sweep(entries, first, moves):
                    break
                best, goal, pose = arrival(lat, widest, goals, target)
                if best > 0 and k > 1:
                    break
        reached = None if best > 0 else self._farthest(cells, widest)
        if best == 0 and (not partial or reached is None):
            return LatticePath(None, None, 0, reached)
        if best > 0 and not cheap:
            return LatticePath(None, None, best, None, moves > FORWARD)
        if best == 0:
            goal = int(
                cells.number[self._index(StandingPose(reached or (0.0, 0.0), self.end.body))]
            )
            pose = widest_pose(lat, widest, goal)
        still_wanted()
        wide = best or int(widest.best[goal])
        level = max(1, min(wide, 150) if wide > 100 else int(0.7 * wide))
        wanted = widest.leading_to(level, goal, moves)
        _core.fill_lag_spans(
            self.path.native, self.s, cells.front, cells.rear, wanted, cells.spans, friction, LAG
        )
        costs = _core.CheapestPaths(
            widest, cells.spans, wanted, level, self._weights(weights or self.weights), moves
        )
        rows = self._smoothest(costs, source, seed, goal, pose, moves)
        if rows is None:
            return LatticePath(None, None, 0, self._farthest(cells, widest))
        s = np.stack([self.s[rows[:, 0]], self.s[rows[:, 1]]], axis=1)
        body = np.stack(
            [rows[:, 4] * lat.step, rows[:, 3] * lat.step, rows[:, 2] * lat.turn], axis=1
        )
        return LatticePath(s, body, best, (float(s[-1, 0]), float(s[-1, 1])), moves > FORWARD)

    def stops(
        self, friction: float, com: float, open_end: bool, torque: float | None = None
    ) -> list[Place]:
        """Where paths end that begin at any pose with the rear wheels at the first sample, and so
        on from where the front wheels ended; see `find`.

        Returns:
            Arc lengths of front and rear wheel, in order; empty where a path leads to the end.
        """
        cells, problem = self._cells(friction, 0.0, com), self._problem(com)
        windows = _windows(problem, cells)
        goals, target = self._goals(cells, open_end)
        out: list[Place] = []
        row = 0
        while len(goals) and row <= cells.rear[goals].max():
            widest = self._widest(problem, windows, cells, friction, torque)
            widest.sweep(cells.rear == row, anywhere(self.lattice), FORWARD)
            end = self._farthest(cells, widest)
            if end is None:
                row += 1
                continue
            if arrival(self.lattice, widest, goals, target)[0] > 0:
                break
            out.append(end)
            row = self._index(StandingPose(end, self.end.body))[0]
        return out

    def _widest(
        self, problem: _core.LatticeProblem, windows: _core.LatticeCells, cells: Cells,
        friction: float, torque: float | None,
    ) -> _core.WidestPaths:  # fmt: skip
        widest = _core.WidestPaths(problem, windows, cells.spans)
        if torque is not None:
            widest.limit_torques(self.path.native, friction, LAG, torque)
        return widest

    def _goals(self, cells: Cells, open_end: bool) -> tuple[Ints, Ints32 | None]:
        """Cells in which paths end, and their pose unless any will do."""
        if open_end:
            return np.flatnonzero(cells.front == len(self.s) - 1), None
        goals = np.flatnonzero(self._only(cells, self.end))
        if not len(goals):
            return goals, None
        return goals, pose_in(self.lattice, cells, int(goals[0]), self.end)

    def _cells(self, friction: float, reserve: float, com: float) -> Cells:
        columns = _core.cells(
            self.path.native, self.s, self.centres, self.pairs, self.lattice.windows,
            friction, reserve, com,
        )  # fmt: skip
        return Cells(**columns)

    def _smoothest(
        self,
        costs: _core.CheapestPaths,
        source: int,
        seed: Ints32,
        goal: int,
        pose: Ints32,
        moves: int,
    ) -> Ints32 | None:
        """Cheapest path from the pose `seed` of cell `source` to one near `pose` of cell `goal`.

        Returns:
            (n, 5) its front and rear samples and lattice poses (pitch, z, x), if it ends.
        """
        for _ in range(1 if moves == FORWARD else 2 * _SWEEPS):
            if not costs.sweep(source, tuple(seed.tolist())):
                break
        last = costs.cheapest_pose(goal, near(self.lattice, pose))
        return costs.backtrack(source, goal, last, 4 * len(self.s) + 400)

    def _weights(self, w: PathWeights) -> _core.LatticeWeights:
        height, wanted = standing_height(self.robot), 0.09 * scale(self.robot)
        return _core.LatticeWeights(w.com_margin, w.pitch, height, wanted, 0.25 * w.smoothness)

    def _problem(self, com: float) -> _core.LatticeProblem:
        return _core.lattice_problem(
            self.model, self.lattice.native, self.s, self.centres, *self.legs, self.trunk,
            self.bounds.legs, com,
        )  # fmt: skip

    def _only(self, cells: Cells, where: StandingPose) -> Flags:
        """Flags (n,) of the one cell of the standing pose `where`, if it has one."""
        out: Flags = np.zeros(len(cells.front), np.bool_)
        c = int(cells.number[self._index(where)])
        if c >= 0:
            out[c] = True
        return out

    def _index(self, where: StandingPose) -> tuple[int, int]:
        return (
            int(np.argmin(np.abs(self.s - where.wheels[0]))),
            int(np.argmin(np.abs(self.s - where.wheels[1]))),
        )

    def _farthest(self, cells: Cells, widest: _core.WidestPaths) -> Place | None:
        """The pair of places farthest along that was reached."""
        found = np.flatnonzero(widest.best)
        if len(found) == 0:
            return None
        sums = self.s[cells.front[found]] + self.s[cells.rear[found]]
        c = found[int(np.argmax(sums))]
        return float(self.s[cells.front[c]]), float(self.s[cells.rear[c]])


def _windows(problem: _core.LatticeProblem, cells: Cells) -> _core.LatticeCells:
    return problem.cells(
        cells.front, cells.rear, cells.t0, cells.z0, cells.x0, cells.slope, cells.origin
    )
