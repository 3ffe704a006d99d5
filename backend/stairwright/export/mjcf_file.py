"""MJCF: terrain, robot and one keyframe per pose, for MuJoCo and its viewer.

The motors become position servos, limited to the robot's torque, and each keyframe's controls
carry the torques that hold its pose at rest, so that a loaded keyframe stands still.
"""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np

from stairwright.arrays import Floats
from stairwright.planning.carrying import holding_torques
from stairwright.planning.plan import Plan
from stairwright.robot import spatial
from stairwright.robot.description import JOINTS, Robot
from stairwright.robot.mujoco_model import build_spec

from .columns import FRAMES, UNITS, plan_arrays

# Servos that hold a pose between two faces must hold the force inside it too: at the robot's own
# feedback gains the wheels creep by centimetres, at three times those by millimetres.
STIFFER = 3.0
WHEEL_STIFFNESS = 180.0  # Nm/rad; the wheels are braked at the keyframe's angle
WHEEL_DAMPING = 2.0  # Nm s/rad
FRICTION_STIFFNESS = 10.0  # of friction over normal constraints, against creep at rest


def plan_mjcf(plan: Plan) -> bytes:
    """One self-contained XML file."""
    robot = plan.robot_description
    spec = build_spec(robot, plan.terrain, plan.friction)
    spec.modelname = "stairwright"
    spec.option.impratio = FRICTION_STIFFNESS
    stiffness = _make_servos(spec, robot)
    arrays = plan_arrays(plan)
    position, quaternion, joints = spatial.lift(
        robot, arrays["trunk"], arrays["q"], arrays["wheel_progress"]
    )
    hold = joints + holding_torques(plan) / stiffness
    for i, pose in enumerate(plan.poses):
        key = spec.add_key(name=f"pose_{i}", time=pose.time)
        key.qpos = np.concatenate([position[i], quaternion[i], joints[i]])
        key.ctrl = hold[i]
    about = {
        "schema": plan.schema_,
        "plan_id": plan.id,
        "terrain_hash": plan.terrain_hash,
        "robot_hash": plan.robot_hash,
        "units": UNITS,
        "frames": FRAMES,
        "joint_order": " ".join(JOINTS),
        "key_poses": " ".join(f"pose_{i}" for i in plan.critical) or "none",
    }
    for name, text in about.items():
        spec.add_text(name=name, data=text)
    spec.compile()  # checks the model, and is needed before it can be written
    return str(spec.to_xml()).encode()


def robot_mjcf(robot: Robot) -> bytes:
    """The robot alone, as it is simulated: torque motors, no ground."""
    spec = build_spec(robot)
    spec.add_text(name="robot_hash", data=robot.hash)
    spec.compile()
    return str(spec.to_xml()).encode()


def _make_servos(spec: Any, robot: Robot) -> Floats:
    """Turn the motors into servos; returns their stiffnesses (12,) [Nm/rad]."""
    stiffness = []
    gains = robot.feedback
    for name, motor in zip(JOINTS, robot.motors, strict=True):
        wheel = name.endswith("wheel")
        kp = WHEEL_STIFFNESS if wheel else STIFFER * gains.joint_stiffness
        kv = WHEEL_DAMPING if wheel else STIFFER**0.5 * gains.joint_damping
        actuator = spec.actuator(name)
        actuator.biastype = mujoco.mjtBias.mjBIAS_AFFINE
        actuator.gainprm[0] = kp
        actuator.biasprm[1], actuator.biasprm[2] = -kp, -kv
        actuator.ctrllimited = False
        actuator.forcelimited = True
        actuator.forcerange = [-motor.torque, motor.torque]
        stiffness.append(kp)
    return np.array(stiffness)
