"""A robot that is given nothing but the exported commands climbs.

Legs follow positions and velocities with a spring, a damper and the efforts, wheels their speeds
with a PI loop: what a joint_trajectory_controller and a velocity group do, in MuJoCo.
"""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

import stairwright as sw
from stairwright.export.table import PLAN_FORMATS
from stairwright.robot import spatial
from stairwright.robot.description import JOINTS
from stairwright.robot.mujoco_model import build_model
from tests.export.mcap_reading import messages
from tests.export.ros2_control import field, times

STIFFNESS, DAMPING = 200.0, 4.0  # of the leg joints, Nm/rad and Nm s/rad
WHEEL_GAIN, WHEEL_INTEGRAL = 2.0, 40.0  # of the wheels' speed loops, Nm s/rad and Nm/rad


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["a1_wheeled", "a1_wheeled_x"])
def test_the_commands_alone_take_the_robot_up_a_ramp(robot: str) -> None:
    """Thirty degrees steep; steps need a balance controller, which shares out the wheels' pull."""
    plan = sw.plan("ramp-30deg-025", robot)
    topics = messages(PLAN_FORMATS["mcap"].write(plan))
    ((_, legs),), ((_, wheels),) = topics["/joint_trajectory"], topics["/wheel_trajectory"]
    model = build_model(plan.robot_description, plan.terrain, plan.friction)
    data = mujoco.MjData(model)
    first, last = plan.poses[0], plan.poses[-1]
    trunk = np.array([[first.x_c, first.z_c, first.pitch]])
    base, turn, joints = spatial.lift(
        plan.robot_description, trunk, np.array([first.q]), np.array([first.wheel_progress])
    )
    data.qpos[:] = np.concatenate([base[0], turn[0], joints[0]])
    leg = [JOINTS.index(name) for name in legs.joint_names]
    wheel = [JOINTS.index(name) for name in wheels.joint_names]
    at, behind = times(legs), np.zeros(4)
    wanted = {name: field(legs, name) for name in ("positions", "velocities", "effort")} | {
        "wheels": field(wheels, "velocities")
    }
    while data.time < at[-1] + 0.5:
        # Points are 10 ms apart: between them a straight line will do.
        i = np.clip(np.searchsorted(at, data.time), 1, len(at) - 1)
        share = np.clip((data.time - at[i - 1]) / (at[i] - at[i - 1]), 0.0, 1.0)
        now = {name: (1 - share) * x[i - 1] + share * x[i] for name, x in wanted.items()}
        q, dq = data.qpos[7:], data.qvel[6:]
        data.ctrl[leg] = (
            now["effort"]
            + STIFFNESS * (now["positions"] - q[leg])
            + DAMPING * (now["velocities"] - dq[leg])
        )
        slow = now["wheels"] - dq[wheel]
        behind += slow * model.opt.timestep
        data.ctrl[wheel] = WHEEL_GAIN * slow + WHEEL_INTEGRAL * behind
        mujoco.mj_step(model, data)
    assert data.qpos[0] == pytest.approx(last.x_c, abs=0.05)
    assert data.qpos[2] == pytest.approx(last.z_c, abs=0.02)
    assert data.body("trunk").xmat[8] > 0.99  # upright
