"""What a rollout simulates: the robot on its terrain, in MuJoCo or in another engine."""

from __future__ import annotations

import re
from typing import Any, Protocol

import mujoco
import numpy as np

from stairwright.arrays import Floats
from stairwright.planning.plan import Plan
from stairwright.robot.description import LEGS
from stairwright.terrain.profile import Terrain

from .disturbance import Disturbance
from .world import build_world, real_terrain

# Two parts of the robot that touch, if any; forces of the terrain on links [N].
Touches = tuple[tuple[str, ...], dict[str, float]]

CONTROL_STEPS = 2  # physics steps per control step: 500 Hz
_PIECE = re.compile(r"(?<=trunk|thigh|_calf)_\d+$")  # of a part that is several shapes
_SUNK = 1e-3  # m that a wheel may start in the terrain
_DIVERGED = (
    mujoco.mjtWarning.mjWARN_BADQPOS,
    mujoco.mjtWarning.mjWARN_BADQVEL,
    mujoco.mjtWarning.mjWARN_BADQACC,
)


class Physics(Protocol):
    """A robot on its terrain.

    Attributes:
        terrain: As it really is.
        source: The file whose model of the robot this is, empty if it is ours.
        timestep: Of the physics [s].
        state: An `MjData`, or what has of it ``time``, ``qpos`` (19,), ``qvel`` (18,), ``ctrl``
            (12,) and the wheels' contact sensors ``sensordata`` (16,) of our own model.
    """

    terrain: Terrain
    source: str
    timestep: float
    state: Any

    def place(self, qpos: Floats) -> None:
        """Put the robot there (19,) at rest, or as much higher as the terrain asks for."""

    def advance(self) -> None:
        """Physics until the next control step, with the torques of ``ctrl``."""

    def touches(self) -> Touches:
        """Contacts that are not a wheel on the terrain."""

    def wheels(self) -> Floats:
        """Centres (4, 3) of the wheels in the world [m]."""

    def broken(self) -> bool:
        """Whether the engine itself has noticed numbers that are not finite."""


class OwnPhysics:
    """MuJoCo with our own model."""

    source = ""

    def __init__(self, plan: Plan, friction: float, disturbance: Disturbance, seed: int) -> None:
        robot, begin = plan.robot_description, plan.poses[0].x_c
        self.terrain = real_terrain(plan.terrain, disturbance, seed)
        self.model = model = build_world(robot, self.terrain, friction, disturbance, begin)
        self.state = mujoco.MjData(model)
        self.timestep = float(model.opt.timestep)
        self._parts = [_PIECE.sub("", model.geom(i).name) for i in range(model.ngeom)]

    def place(self, qpos: Floats) -> None:
        """See `Physics`."""
        self.state.qpos[:] = qpos
        mujoco.mj_forward(self.model, self.state)
        if depth := sunk(self.state):
            self.state.qpos[2] += depth
            mujoco.mj_forward(self.model, self.state)

    def advance(self) -> None:
        """See `Physics`."""
        mujoco.mj_step(self.model, self.state, CONTROL_STEPS)

    def touches(self) -> Touches:
        """See `Physics`."""
        return touches(self.model, self.state, self._parts)

    def wheels(self) -> Floats:
        """See `Physics`."""
        return np.array([self.state.body(f"{leg}_wheel").xpos for leg in LEGS])

    def broken(self) -> bool:
        """See `Physics`."""
        return warned(self.state)


def sunk(data: Any) -> float:
    """How deep the robot stands in the terrain, which may be another one than planned [m]."""
    depth = max((-float(d) for d in data.contact.dist), default=0.0)
    return depth if depth > _SUNK else 0.0


def warned(data: Any) -> bool:
    """MuJoCo starts anew, with a warning, when it finds numbers that are not finite."""
    return any(data.warning[kind].number for kind in _DIVERGED)


def touches(model: Any, data: Any, parts: list[str]) -> Touches:
    """See `Physics`; `parts` says what each shape is part of."""
    loads: dict[str, float] = {}
    wheels = int(data.sensordata[0:16:4].sum())
    if data.sensordata[16] == wheels:
        return (), loads
    force, own = np.zeros(6), tuple[str, ...]()
    for i, (a, b) in enumerate(data.contact.geom[: data.ncon]):
        first, second = parts[a], parts[b]
        if second.startswith("terrain"):
            first, second = second, first
        if not first.startswith("terrain"):
            own = (first, second)
        elif not second.endswith("wheel"):
            mujoco.mj_contactForce(model, data, i, force)
            loads[second] = loads.get(second, 0.0) + float(np.hypot(*force[:2]))
    return own, loads
