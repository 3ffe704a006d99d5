"""A robot's own MuJoCo file in the place of our model of it."""

from __future__ import annotations

import math
import os
from typing import Any

import mujoco
import numpy as np

from stairwright.arrays import Floats
from stairwright.control.measurement import rotation
from stairwright.errors import InputError
from stairwright.planning.plan import Plan
from stairwright.robot.description import JOINTS

from .disturbance import Disturbance
from .original import Original, build_original, read_original
from .physics import CONTROL_STEPS, Touches, sunk, touches, warned
from .world import real_terrain

# Deviations that change our own model of the robot or of the world round it.
_OUR_MODEL = (
    "mass", "com_x", "com_z", "payload", "friction_front", "friction_rear", "heading",
    "cross_slope",
)  # fmt: skip


class Mirror:
    """The state of a file's model as our own model's `MjData` would have it.

    `qpos` (19,), `qvel` (18,) and `ctrl` (12,) are copies in our layout: `read` fetches the state,
    `write` hands the torques over. Everything else is the file's own.
    """

    def __init__(self, original: Original) -> None:
        self.original = original
        self.data = mujoco.MjData(original.model)
        self.qpos, self.qvel, self.ctrl = np.zeros(19), np.zeros(18), np.zeros(12)
        self._signs = np.array([own.sign for own in original.maps])
        self._offsets = np.array([own.offset for own in original.maps])
        self.data.ctrl[12:] = list(original.held.values())

    def __getattr__(self, name: str) -> Any:
        return getattr(self.data, name)

    def place(self) -> None:
        """Put the file's model where `qpos` is, at rest."""
        own, data = self.original, self.data
        data.qpos[:] = own.positions_with(self.qpos[7:])
        turn = rotation(self.qpos[3:7]) @ own.axes  # of the trunk's body
        root = self._root()
        place = self.qpos[:3] - turn @ own.centre
        mujoco.mj_kinematics(own.model, data)
        # The free joint's body may carry the trunk's: move it so that the trunk comes right.
        first = data.xmat[root].reshape(3, 3).T @ data.xmat[own.base].reshape(3, 3)
        shift = data.xmat[root].reshape(3, 3).T @ (data.xpos[own.base] - data.xpos[root])
        carried = turn @ first.T
        data.qpos[:3] = place - carried @ shift
        mujoco.mju_mat2Quat(data.qpos[3:7], carried.ravel())
        data.qvel[:] = 0.0
        mujoco.mj_forward(own.model, data)
        self.read()

    def read(self) -> None:
        """Fetch the state."""
        own, data = self.original, self.data
        body = data.xmat[own.base].reshape(3, 3)
        turn = body @ own.axes.T
        self.qpos[:3] = data.xpos[own.base] + body @ own.centre
        quaternion = np.empty(4)
        mujoco.mju_mat2Quat(quaternion, turn.ravel())
        self.qpos[3:7] = quaternion * math.copysign(1.0, quaternion @ self.qpos[3:7])
        self.qpos[7:] = self._signs * data.qpos[own.positions] + self._offsets
        moving = np.empty(6)
        mujoco.mj_objectVelocity(own.model, data, mujoco.mjtObj.mjOBJ_XBODY, own.base, moving, 0)
        spin = moving[:3]
        self.qvel[:3] = moving[3:] + np.cross(spin, body @ own.centre)
        self.qvel[3:6] = turn.T @ spin
        self.qvel[6:] = self._signs * data.qvel[own.speeds]

    def write(self) -> None:
        """Hand over the torques."""
        self.data.ctrl[:12] = self._signs * self.ctrl

    def _root(self) -> int:
        return int(self.original.model.body_rootid[self.original.base])


class OriginalPhysics:
    """MuJoCo with the file `model`, whose state is a `Mirror`.

    Raises:
        InputError: If the file is not the plan's robot, or cannot carry out what is asked.
    """

    def __init__(
        self,
        model: str | os.PathLike[str],
        plan: Plan,
        friction: float,
        disturbance: Disturbance,
        seed: int,
    ) -> None:
        for name in _OUR_MODEL:
            if getattr(disturbance, name):
                raise InputError("is for our own model of the robot", ("disturbance", name))
        robot = plan.robot_description
        upload, self.reading = read_original(model, robot, plan.facing)
        self.terrain = terrain = real_terrain(plan.terrain, disturbance, seed)
        friction = max(0.01, friction + disturbance.friction)
        self.original = own = build_original(
            upload, self.reading, robot, terrain, friction, plan.facing
        )
        maps = (f"{ours} <- {made.name}" for ours, made in zip(JOINTS, own.maps, strict=True))
        self.source = f"{self.reading.robot.source}: {', '.join(maps)}"
        self.state = Mirror(self.original)
        self.timestep = float(self.original.model.opt.timestep)

    def place(self, qpos: Floats) -> None:
        """See `Physics`."""
        mirror = self.state
        mirror.qpos[:] = qpos
        mirror.place()
        if depth := sunk(mirror.data):
            mirror.qpos[2] += depth
            mirror.place()

    def advance(self) -> None:
        """See `Physics`."""
        mirror = self.state
        mirror.write()
        mujoco.mj_step(self.original.model, mirror.data, CONTROL_STEPS)
        mirror.read()

    def touches(self) -> Touches:
        """See `Physics`."""
        return touches(self.original.model, self.state.data, self.original.labels)

    def wheels(self) -> Floats:
        """See `Physics`."""
        own, data = self.original, self.state.data
        places = [
            data.xpos[body] + data.xmat[body].reshape(3, 3) @ plane
            for body, plane in zip(own.wheels, own.planes, strict=True)
        ]
        return np.array(places)

    def broken(self) -> bool:
        """See `Physics`."""
        return warned(self.state.data)
