"""The controller of the native core (native/include/stairwright/control), form ``contact``.

It gives the same torques as `controller.Controller`, the readable numpy form that a test compares
it with, and runs without Python: in the rollout's loop, or on a robot.
"""

from __future__ import annotations

from stairwright import _core
from stairwright.robot.description import Robot
from stairwright.terrain.wheel_path import WheelPath

from .controller import gains
from .settings import ControllerSettings

OF_SETTINGS = (
    "wheel_sync",
    "yaw_damping",
    "heading_stiffness",
    "com_stiffness",
    "com_damping",
    "pitch_stiffness",
    "pitch_damping",
    "pitch_integral",
    "roll_stiffness",
    "roll_damping",
    "force_weight",
    "moment_weight",
    "alpha",
    "beta",
    "friction_share",
)
OF_ROBOT = ("joint_stiffness", "joint_damping", "wheel_damping", "force_limit")


def native_controller(
    robot: Robot, path: WheelPath, friction: float, settings: ControllerSettings
) -> _core.Controller:
    """A controller at the start of its work; `friction` is what the plan was made for."""
    own, native = gains(robot, settings), _core.Gains()
    for name in OF_SETTINGS:
        setattr(native, name, getattr(settings, name))
    for name in OF_ROBOT:
        setattr(native, name, getattr(own, name))
    return _core.Controller(robot.native, path.native, friction, native)
