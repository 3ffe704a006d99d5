"""What the controller gets to know in a rollout: the state, or what the robot's sensors say."""

from __future__ import annotations

from stairwright import _core
from stairwright.control.settings import ControllerSettings
from stairwright.planning.plan import Plan
from stairwright.terrain.wheel_path import WheelPath

from .disturbance import Disturbance


def perception(
    plan: Plan,
    path: WheelPath,
    settings: ControllerSettings,
    deviation: Disturbance,
    late: int,
    seed: int,
) -> _core.IdealSense | _core.RobotSense:
    """What senses for the controller.

    Args:
        plan: Its first pose is where the robot believes to start.
        path: The wheel-centre curve that the robot knows.
        settings: Its `sensing` counts.
        deviation: How sensors are wrong.
        late: Control steps from sensing to torque.
        seed: Of the sensors' noise.
    """
    start = plan.poses[0]
    if settings.sensing == "ideal":
        return _core.IdealSense(
            late, start.x_c, deviation.x_offset, deviation.odometry_scale, deviation.pitch_bias
        )
    return _core.RobotSense(
        plan.robot_description.native,
        path.native,
        start=(start.x_c, start.z_c),
        pitch=start.pitch,
        errors=_sensor_errors(deviation),
        delay_steps=late,
        seed=seed,
    )


def _sensor_errors(deviation: Disturbance) -> _core.SensorErrors:
    imu = deviation.imu
    errors = _core.SensorErrors(max(1.0, deviation.noise))  # real sensors have it anyway
    errors.wheel_scale, errors.tilt = deviation.odometry_scale, deviation.pitch_bias
    errors.gyro_offset, errors.force_offset = [imu.gyro_bias] * 3, [imu.accelerometer_bias] * 3
    if imu.gyro_noise is not None:
        errors.gyro = imu.gyro_noise
    if imu.accelerometer_noise is not None:
        errors.specific_force = imu.accelerometer_noise
    return errors
