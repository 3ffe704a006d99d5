"""A small valid plan and rollout made with kinematics alone: scene and exports need no planner."""

from __future__ import annotations

import numpy as np

from stairwright.control.settings import ControllerSettings
from stairwright.library import load_robot
from stairwright.planning.plan import Margins, Plan, Pose, Timing, plan_id
from stairwright.planning.problem import Limit, Problem
from stairwright.robot import kinematics
from stairwright.robot.spatial import lift
from stairwright.scene.clearance import clearance
from stairwright.simulation.result import Metrics, Rollout, Series
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import wheel_path

STEPS = [(-1.2, 0.0), (0.0, 0.0), (0.0, 0.1), (0.3, 0.1), (0.3, 0.2), (0.75, 0.2), (1.15, 0.285)]


def example_terrain(friction: float = 0.6) -> Terrain:
    return Terrain(name="two steps", points=[*STEPS, (2.3, 0.285)], friction=friction)


def example_plan(count: int = 90, robot: str = "a1_wheeled_x", problem: bool = False) -> Plan:
    """Wheels roll along the curve a fixed arc apart, the trunk rides above their middle."""
    terrain, machine = example_terrain(), load_robot(robot)
    path = wheel_path(terrain, machine.wheel.radius)
    rear = np.linspace(0.35, path.length - 0.62, count)
    front = rear + machine.hips.front[0] - machine.hips.rear[0] + 0.02
    wheels = np.stack([path.centres(front), path.centres(rear)], axis=1)
    contacts = np.stack([path.contacts(front), path.contacts(rear)], axis=1)
    normals = np.stack([path.normals(front), path.normals(rear)], axis=1)
    span = wheels[:, 0] - wheels[:, 1]
    pitch = -0.6 * np.arctan2(span[:, 1], span[:, 0])
    middle = wheels.mean(axis=1) + np.array([0.0, machine.nominal_height - 0.05])
    q = kinematics.inverse(machine, middle[:, 0], middle[:, 1], pitch, wheels)
    assert np.isfinite(q).all()
    frames = kinematics.forward(machine, middle[:, 0], middle[:, 1], pitch, q)
    com = kinematics.com(machine, middle[:, 0], middle[:, 1], pitch, frames)
    points = kinematics.collision_points(machine, middle[:, 0], middle[:, 1], pitch, q)
    load = machine.mass * 9.81 * (com[:, 0] - contacts[:, 1, 0])
    load = load / (contacts[:, 0, 0] - contacts[:, 1, 0])
    vertical = np.stack([load, machine.mass * 9.81 - load], axis=1)[..., None]
    # Vertical forces share the weight; in the contact frame: tangential, normal.
    forces = vertical * np.stack([-normals[..., 0], normals[..., 1]], axis=-1)
    progress = (front + rear) / 2 - (front[0] + rear[0]) / 2
    poses = [
        Pose(
            progress=progress[i],
            time=progress[i] / 0.12,
            x_c=middle[i, 0],
            z_c=middle[i, 1],
            pitch=pitch[i],
            q=tuple(q[i]),
            wheels=tuple(map(tuple, wheels[i])),
            wheel_progress=(front[i], rear[i]),
            contacts=tuple(map(tuple, contacts[i])),
            com=tuple(com[i]),
            collision_points=[tuple(p) for p in points[i]],
            forces=tuple(map(tuple, forces[i])),
            margins=Margins(
                clearance=float(clearance(terrain.vertices, points[i]).min()),
                com=float(min(contacts[i, 0, 0] - com[i, 0], com[i, 0] - contacts[i, 1, 0])),
                friction=0.31,
                torque=9.8,
            ),
        )
        for i in range(count)
    ]
    stop = None
    if problem:
        poses = poses[: count // 2]
        stop = Problem(
            kind="clearance",
            at=(0.3, 0.2),
            progress=poses[-1].progress,
            message="Rear calf cuts the 2nd nosing by 8 mm",
            limit=Limit(needed=0.0, available=-0.008, quantity="clearance", unit="m"),
        )
    return Plan(
        id=plan_id(terrain, machine, 0.6, "path", {}),
        method="path",
        terrain=terrain,
        terrain_hash=terrain.hash,
        robot=machine.name,
        robot_hash=machine.hash,
        robot_description=machine,
        friction=0.6,
        status="infeasible" if problem else "feasible",
        problem=stop,
        poses=poses,
        critical=list(range(0, len(poses), max(1, len(poses) // 6))),
        timing=Timing(total=poses[-1].time),
        solve_time=0.004,
    )


def example_rollout(plan: Plan | None = None) -> Rollout:
    """A rollout document around `example_series`."""
    plan = plan or example_plan()
    keys = set(Metrics.model_fields)
    return Rollout(
        id="r-0123456789abcdef",
        plan_id=plan.id,
        method=plan.method,
        terrain=plan.terrain,
        terrain_hash=plan.terrain_hash,
        robot=plan.robot,
        robot_hash=plan.robot_hash,
        robot_description=plan.robot_description,
        friction=plan.friction,
        seed=0,
        controller=ControllerSettings(),
        outcome="success",
        reason="all wheels stand where the plan ends",
        metrics=Metrics(**{**dict.fromkeys(keys, 0), "duration": plan.timing.total}),
        series=Series(**example_series(plan)),
        plan=plan,
    )


def example_series(plan: Plan, rate: float = 100.0) -> dict[str, list]:
    """Series of a perfect run of `plan`, with a small wobble so that tracking shows an error."""
    time = np.arange(0.0, plan.timing.total, 1.0 / rate)
    knots = [pose.time for pose in plan.poses]

    def along(values: object) -> np.ndarray:
        rows = np.asarray(values, float).reshape(len(knots), -1)
        return np.stack([np.interp(time, knots, column) for column in rows.T], axis=1)

    trunk = along([(p.x_c, p.z_c, p.pitch) for p in plan.poses])
    q = along([p.q for p in plan.poses])
    rolled = along([p.wheel_progress for p in plan.poses])
    _, _, desired = lift(plan.robot_description, trunk, q, rolled)
    wobble = 0.01 * np.sin(3.0 * time)
    actual = trunk + np.stack([0 * wobble, 0 * wobble, wobble], axis=1)
    position, quaternion, joints = lift(plan.robot_description, actual, q, rolled)
    weight = plan.robot_description.mass * 9.81
    forces = np.tile([0.0, weight / 4], (len(time), 4, 1))
    return {
        "time": time.tolist(),
        "base_position": position.tolist(),
        "base_quaternion": quaternion.tolist(),
        "q": joints.tolist(),
        "q_desired": desired.tolist(),
        "dq": np.gradient(joints, 1 / rate, axis=0).tolist(),
        "torque": np.zeros_like(joints).tolist(),
        "pitch": actual[:, 2].tolist(),
        "pitch_desired": trunk[:, 2].tolist(),
        "progress": along([p.progress for p in plan.poses])[:, 0].tolist(),
        "progress_desired": along([p.progress for p in plan.poses])[:, 0].tolist(),
        "contact_force": forces.tolist(),
    }
