"""From nodes to the plan document."""

from __future__ import annotations

import time as clock

import numpy as np
from numpy.typing import NDArray

from stairwright.planning.binding import binding_of
from stairwright.planning.plan import Margins, Plan, Pose, Problem, Timing, plan_id
from stairwright.planning.smoothing.path_timing import path_parameter, pose_times
from stairwright.planning.smoothing.refine import Refined
from stairwright.planning.standing import CORNER, kink
from stairwright.planning.tolerance import Tolerance
from stairwright.planning.weights import PathWeights
from stairwright.robot import kinematics as kin
from stairwright.robot.description import Robot
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import WheelPath

Floats = NDArray[np.float64]


def make_poses(
    path: WheelPath, robot: Robot, found: Refined, weights: PathWeights
) -> tuple[list[Pose], list[int], float]:
    """Poses, indices of the key poses, and the duration [s]."""
    s, body, m = found.s, found.body, found.margins
    q = m.q
    time = pose_times(robot, s, body, q, m.firm_com_margin, m.torque_shares("leg"), weights.speed)
    progress = path_parameter(s, body)
    wheels = np.stack([path.centres(s[:, k]) for k in range(2)], axis=1)
    contacts = np.stack([path.contacts(s[:, k]) for k in range(2)], axis=1)
    points = kin.collision_points(robot, body[:, 0], body[:, 1], body[:, 2], q)
    spare = (m.clearance, m.com_margin, m.friction - m.friction_needed, m.torque_margin("leg"))
    columns = (
        progress.tolist(), time.tolist(), *body.T.tolist(), _tuples(q), _pairs(wheels), _tuples(s),
        _pairs(contacts), _tuples(m.com), _groups(points), _pairs(m.forces),
        *(one.tolist() for one in spare),
    )  # fmt: skip
    poses = [
        # The values are ours: validating thousands of floats would cost more than planning them.
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
    return poses, key_poses(path, s), float(time[-1])


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
    poses: list[Pose] | None = None,
    critical: list[int] | None = None,
    total: float = 0.0,
    problem: Problem | None = None,
    tolerance: Tolerance | None = None,
) -> Plan:
    """The document around poses or a problem."""
    chosen = weights.model_dump()
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
        poses=poses or [],
        critical=critical or [],
        timing=Timing(total=total),
        solve_time=clock.perf_counter() - begun,
        certificate=None,
        knees=None,
        binding=binding_of(robot, friction, poses or []),
        tolerance=tolerance,
    )
