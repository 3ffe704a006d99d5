"""From nodes to the plan document."""

from __future__ import annotations

import time as clock
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np

from stairwright.arrays import Floats
from stairwright.documents import Deferred
from stairwright.planning import binding
from stairwright.planning.plan import Binding, Margins, Plan, Pose, Quantity, Timing, plan_id
from stairwright.planning.pose_arrays import PoseArrays
from stairwright.planning.problem import Problem
from stairwright.planning.smoothing.path_timing import path_parameter, pose_times
from stairwright.planning.smoothing.refine import Refined
from stairwright.planning.tolerance import Tolerance
from stairwright.planning.weights import PathWeights
from stairwright.planning.wheel_samples import CORNER, kink
from stairwright.robot import kinematics as kin
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import WheelPath


@dataclass(frozen=True)
class PathPoses:
    """The poses of a path of n nodes; their documents are made when they are needed.

    Attributes:
        path: The wheel-centre curve.
        robot: Who stands in them.
        nodes: What the poses are made of.
        progress: (n,) way since the start [m].
        time: (n,) planned time since the start [s].
    """

    path: WheelPath
    robot: Robot
    nodes: Refined
    progress: Floats
    time: Floats

    @classmethod
    def of(cls, path: WheelPath, robot: Robot, nodes: Refined, weights: PathWeights) -> Self:
        """Those of nodes, timed within limits of speed."""
        s, body, m = nodes.s, nodes.body, nodes.margins
        effort = m.torque_shares("leg")
        time = pose_times(robot, s, body, m.q, m.firm_com_margin, effort, weights.speed)
        return cls(path, robot, nodes, path_parameter(s, body), time)

    @cached_property
    def _spare(self) -> Floats:
        """(4, n) margins as documents tell them: clearance, CoM, friction, torque."""
        m = self.nodes.margins
        friction = m.friction - m.friction_needed
        return np.stack([m.clearance, m.com_margin, friction, m.torque_margin("leg")])

    @property
    def margins(self) -> binding.Margins:
        """Margins of the poses, as their documents tell them."""
        m = self.nodes.margins
        return binding.Margins(self.robot, m.friction, self._spare, m.q, m.forces[:, :, 0])

    @property
    def arrays(self) -> PoseArrays:
        """The same numbers as in the documents."""
        nodes = self.nodes
        return PoseArrays(self.progress, self.time, nodes.body, nodes.margins.q, nodes.s)

    @property
    def deferred(self) -> Deferred:
        """Stands for the documents until they are needed."""
        return Deferred(self.documents, self)

    def binding(self) -> Binding:
        """The margin that binds, and where."""
        return self.margins.binding(self.progress)

    def key_poses(self) -> list[int]:
        """Indices of start, end, and where a wheel enters a concave corner or leaves a nosing."""
        return key_poses(self.path, self.nodes.s)

    def documents(self) -> list[Pose]:
        """One a node."""
        s, body, m = self.nodes.s, self.nodes.body, self.nodes.margins
        wheels = np.stack([self.path.centres(s[:, k]) for k in range(2)], axis=1)
        contacts = np.stack([self.path.contacts(s[:, k]) for k in range(2)], axis=1)
        points = kin.collision_points(self.robot, body[:, 0], body[:, 1], body[:, 2], m.q)
        columns = (
            self.progress.tolist(), self.time.tolist(), *body.T.tolist(), _tuples(m.q),
            _pairs(wheels), _tuples(s), _pairs(contacts), _tuples(m.com), _groups(points),
            _pairs(m.forces), *self._spare.tolist(),
        )  # fmt: skip
        return [
            # The values are ours: validating thousands of floats costs more than planning them.
            Pose.trusted(
                progress=u,
                time=t,
                x_c=x,
                z_c=z,
                pitch=pitch,
                q=j,
                wheels=w,
                wheel_progress=sw,
                contacts=c,
                com=centre,
                collision_points=cp,
                forces=f,
                margins=Margins.trusted(clearance=clear, com=tip, friction=slip, torque=load),
            )
            for u, t, x, z, pitch, j, w, sw, c, centre, cp, f, clear, tip, slip, load in zip(
                *columns, strict=True
            )
        ]


def _tuples(rows: Floats) -> list[tuple[float, ...]]:
    """(n, m) numbers as n tuples, without a list a row: the collector walks them."""
    return list(zip(*rows.T.tolist(), strict=True))


def _pairs(points: Floats) -> list[tuple[tuple[float, ...], ...]]:
    """(n, 2, 2) points of front and rear as n pairs of tuples."""
    return list(zip(_tuples(points[:, 0]), _tuples(points[:, 1]), strict=True))


def _groups(points: Floats) -> list[list[tuple[float, ...]]]:
    """(n, m, 2) points as n lists of tuples."""
    n, m = points.shape[:2]
    flat = _tuples(points.reshape(n * m, 2))
    return [flat[k * m : (k + 1) * m] for k in range(n)]


def poses_at(plan: Plan, times: Floats) -> Any:
    """The poses of a plan at other times (n,) [s]; as documents if they are documents already."""
    source = Deferred.source_of(plan, "poses")
    if isinstance(source, PathPoses):
        return replace(source, time=times).deferred
    return [
        pose.model_copy(update={"time": time})
        for pose, time in zip(plan.poses, times.tolist(), strict=True)
    ]


def key_poses(path: WheelPath, s: Floats) -> list[int]:
    """Start, end, and where a wheel enters a concave corner or leaves a nosing."""
    keys = {0, len(s) - 1}
    marks = [float(c) for c in path.corners if kink(path, float(c)) > CORNER]
    for piece in path.pieces:
        if piece[0] == 1.0 and piece[2] / path.radius > 4 * CORNER:
            marks.append(float(piece[1] + piece[2]))
    for mark in marks:
        for wheel in range(2):
            column = s[:, wheel]
            if column.min() < mark < column.max():
                keys.add(int(np.argmax(column >= mark)))
    return sorted(keys)


def make_plan(
    terrain: Terrain,
    robot: Robot,
    friction: float,
    weights: PathWeights,
    begun: float,
    poses: PathPoses | None = None,
    problem: Problem | None = None,
    tolerance: Tolerance | None = None,
) -> Plan:
    """The document around poses or a problem."""
    chosen = weights.model_dump()
    documents: Any = poses.deferred if poses else []
    return Plan.model_construct(
        schema_="stairwright/plan/1",
        id=plan_id(terrain, robot, friction, "path", chosen, tolerance=tolerance),
        method="path",
        terrain=terrain,
        terrain_hash=terrain.hash,
        robot=robot.name,
        robot_hash=robot.hash,
        robot_description=robot,
        friction=friction,
        weights=chosen,
        status="infeasible" if problem else "feasible",
        problem=problem,
        poses=documents,
        critical=poses.key_poses() if poses else [],
        timing=Timing(total=float(poses.time[-1]) if poses else 0.0),
        solve_time=clock.perf_counter() - begun,
        certificate=None,
        knees=None,
        facing="forward",
        binding=poses.binding() if poses else None,
        tolerance=tolerance,
    )


def least_margins(plan: Plan) -> dict[Quantity, float]:
    """The least margin of each kind over a plan's poses; see `binding.Margins.measured`.

    Documents of a path's poses are not made for it, nor by `distance_covered`.
    """
    poses = Deferred.source_of(plan, "poses")
    if isinstance(poses, PathPoses):
        margins = poses.margins
    else:
        margins = binding.Margins.of(plan.robot_description, plan.friction, plan.poses)
    return {name: float(values.min()) for name, (values, _) in margins.measured().items()}


def distance_covered(plan: Plan) -> float:
    """How far a plan's last pose is from its start [m]."""
    poses = Deferred.source_of(plan, "poses")
    return float(poses.progress[-1] if isinstance(poses, PathPoses) else plan.poses[-1].progress)
