"""MCAP for ROS 2 and Foxglove: the robot, the terrain, and how the one moves on the other.

Both files hold ``/robot_description`` (URDF), ``/tf_static``, ``/tf``, ``/joint_states``,
``/terrain`` (a Marker) and ``/path`` (of the trunk): a viewer shows the robot on its terrain with
nothing else set up. A plan adds the commands that its robot's controllers take, see
`joint_commands`; a rollout what was asked of the joints. Quaternions are xyzw here and only here.
Times count from zero; joints bear the robot's own names.
"""

from __future__ import annotations

import json

import numpy as np

from stairwright.arrays import Floats
from stairwright.planning.plan import Plan
from stairwright.robot import spatial
from stairwright.robot.description import JOINTS, LEGS, Robot
from stairwright.robot.kinematics import lengths
from stairwright.simulation.result import Rollout
from stairwright.terrain.profile import Terrain

from .columns import FRAMES, SHOWN_HALF_WIDTH, UNITS, plan_arrays
from .joint_commands import JointCommands, joint_commands
from .mcap_bag import Bag, stamp
from .urdf_file import FIXED_FRAMES, TRUNK, robot_urdf

WORLD = "world"
STATE_RATE = 50.0  # Hz; a plan's joint states and transforms, at most
MOST_STATES = 20_000  # of a plan
TERRAIN_DEPTH = 0.1  # m below the lowest point
TERRAIN_COLOUR = (0.62, 0.65, 0.70, 1.0)
_WHEELS = slice(2, 12, 3)
_LEGS = [j for j in range(12) if j % 3 != 2]


def plan_mcap(plan: Plan, rate: float) -> bytes:
    """A plan and its commands, `rate` of them a second [Hz].

    Raises:
        InputError: If the plan lasts too long.
    """
    for pose in plan.poses:
        stamp(pose.time)
    plan_arrays(plan)  # complains about poses that are not this robot's
    robot = plan.robot_description
    about = {"id": plan.id, "method": plan.method, "rate": repr(float(rate)), **_about(plan)}
    bag = Bag(about)
    _scenery(bag, robot, plan.terrain)
    if len(plan.poses) < 2:  # nothing moves
        return bag.finish()
    made = joint_commands(plan, rate)
    _commands(bag, robot, made)
    step = max(1, round(rate / STATE_RATE), -(-len(made.time) // MOST_STATES))
    shown = np.union1d(np.arange(0, len(made.time), step), len(made.time) - 1)
    time, position, turn = made.time[shown], made.base_position[shown], made.base_quaternion[shown]
    q, dq, effort = made.position[shown], made.velocity[shown], made.effort[shown]
    bag.path("/path", WORLD, time, position, turn)
    own, sign = _own_angles(robot, q), robot.ros_frames[0]
    bag.joint_states("/joint_states", robot.ros_joints, time, own, sign * dq, sign * effort)
    _transforms(bag, robot, time, position, turn, q)
    return bag.finish()


def rollout_mcap(rollout: Rollout) -> bytes:
    """A rollout as it was simulated."""
    s, robot = rollout.series, rollout.robot_description
    about = {"id": rollout.id, "plan_id": rollout.plan_id, "outcome": rollout.outcome}
    bag = Bag({**about, **_about(rollout)})
    _scenery(bag, robot, rollout.terrain)
    desired, sign = _own_angles(robot, s.q_desired), robot.ros_frames[0]
    bag.trajectory("/joint_trajectory", robot.ros_joints, s.time, positions=desired)
    bag.path("/path", WORLD, s.time, s.base_position, s.base_quaternion)
    own = _own_angles(robot, s.q)
    bag.joint_states("/joint_states", robot.ros_joints, s.time, own, sign * s.dq, sign * s.torque)
    _transforms(bag, robot, s.time, s.base_position, s.base_quaternion, s.q)
    return bag.finish()


def _commands(bag: Bag, robot: Robot, made: JointCommands) -> None:
    """What ros2_control's joint_trajectory_controller takes.

    The first point comes one period after the start, still at rest: where there are velocities
    alone, the controller integrates them from the state that it finds.
    """
    legs, sign = [robot.ros_joints[j] for j in _LEGS], robot.ros_frames[0]
    fields = {
        "positions": _own_angles(robot, made.position)[1:, _LEGS],
        "velocities": (sign * made.velocity)[1:, _LEGS],
        "accelerations": (sign * made.acceleration)[1:, _LEGS],
    }
    effort = (sign * made.effort)[1:, _LEGS]
    bag.trajectory("/joint_trajectory", legs, made.time[1:], **fields, effort=effort)
    # Controllers without an effort interface refuse trajectories that have efforts.
    bag.trajectory("/joint_trajectory_without_effort", legs, made.time[1:], **fields)
    wheels, speeds = robot.ros_joints[_WHEELS], (sign * made.velocity)[1:, _WHEELS]
    bag.trajectory("/wheel_trajectory", wheels, made.time[1:], velocities=speeds)


def _own_angles(robot: Robot, q: Floats) -> Floats:
    """Joint angles (n, 12) as the robot's own software counts them."""
    sign, offset = robot.ros_frames
    counted: Floats = sign * (q - offset)
    return counted


def _scenery(bag: Bag, robot: Robot, terrain: Terrain) -> None:
    """What does not move: the robot's description, its fixed frames, and the terrain."""
    bag.text("/robot_description", robot_urdf(robot).decode())
    at = np.zeros((1, len(FIXED_FRAMES), 3))
    level = np.tile([1.0, 0.0, 0.0, 0.0], (1, len(FIXED_FRAMES), 1))
    frames = [(TRUNK, frame) for frame in FIXED_FRAMES]
    bag.transforms("/tf_static", np.zeros(1), frames, at, level, keep=True)
    bag.triangles("/terrain", WORLD, terrain_triangles(terrain), TERRAIN_COLOUR)


def _transforms(
    bag: Bag, robot: Robot, time: Floats, position: Floats, quaternion: Floats, q: Floats
) -> None:
    """``/tf``: world to trunk, trunk to thigh to calf to wheel of each leg."""
    offsets = np.zeros((len(time), 13, 3))
    offsets[:, 0] = position
    offsets[:, 1::3] = spatial.hip_offsets(robot)
    upper, lower = lengths(robot)
    offsets[:, 2::3, 2], offsets[:, 3::3, 2] = -np.repeat(upper, 2), -np.repeat(lower, 2)
    turns = np.concatenate([quaternion[:, None], spatial.quaternion_y(np.asarray(q))], axis=1)
    parents = [p for leg in LEGS for p in (TRUNK, f"{leg}_thigh", f"{leg}_calf")]
    frames = [(WORLD, TRUNK), *zip(parents, JOINTS, strict=True)]
    bag.transforms("/tf", time, frames, offsets, turns)


def terrain_triangles(terrain: Terrain) -> Floats:
    """Corners (3 n, 3) of triangles [m]: the surface, and the cut faces on both sides."""
    p = terrain.vertices
    left, right = (np.insert(p, 1, y, axis=1) for y in (SHOWN_HALF_WIDTH, -SHOWN_HALF_WIDTH))
    floor = float(p[:, 1].min()) - TERRAIN_DEPTH
    quads = [(right, left)]  # each between two lines of points along the terrain
    for side in (left, right):
        below = side.copy()
        below[:, 2] = floor
        quads.append((below, side))
    strips = [np.stack([a[:-1], a[1:], b[1:], a[:-1], b[1:], b[:-1]], axis=1) for a, b in quads]
    return np.concatenate(strips).reshape(-1, 3)


def _about(document: Plan | Rollout) -> dict[str, str]:
    return {
        "schema": document.schema_,
        "terrain": document.terrain.name,
        "terrain_hash": document.terrain_hash,
        "robot": document.robot,
        "robot_hash": document.robot_hash,
        "friction": repr(document.friction),
        "units": UNITS,
        "frames": FRAMES + "; quaternions xyzw",
        "joint_order": json.dumps(document.robot_description.ros_joints),
    }
