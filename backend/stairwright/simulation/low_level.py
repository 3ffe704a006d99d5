"""A simulated robot behind a socket: what a player elsewhere drives by low-level commands.

The packets are those of native/player/udp_link.hpp. The player learns what sensors say and tells
16 motors what to do; nothing else passes, so it cannot know or touch the simulator's state. Time
is the simulation's: it waits for each answer, however long that takes.
"""

from __future__ import annotations

import math
import os
import socket
import struct
import time
from dataclasses import dataclass

import numpy as np

from stairwright import _core
from stairwright._core import GRAVITY
from stairwright.arguments import as_friction
from stairwright.arrays import Floats
from stairwright.control.settings import ControllerSettings
from stairwright.errors import InputError
from stairwright.planning.plan import Plan
from stairwright.robot.description import JOINTS, LEGS, Robot
from stairwright.robot.turning import opposite, turned

from .disturbance import Disturbance
from .end_error import end_error
from .original_physics import OriginalPhysics
from .outcome import Ending, fallen, judge
from .physics import OwnPhysics, Physics
from .result import Outcome
from .run import Run

MOTORS = 16
MOTOR_LEGS = ("FR", "FL", "RR", "RL")  # abduction, thigh, calf of each; then their wheels
# Number of the motor of each of our 12 joints, and of each leg's abduction (FL, FR, RL, RR).
MOTOR_OF = np.array(
    [
        12 + MOTOR_LEGS.index(name[:2])
        if name.endswith("wheel")
        else 3 * MOTOR_LEGS.index(name[:2]) + 1 + name.endswith("calf")
        for name in JOINTS
    ]
)
ABDUCTION_OF = np.array([3 * MOTOR_LEGS.index(leg) for leg in LEGS])
_RETRY = 0.05  # s
_STATE = struct.Struct("<4sId54f")
_COMMAND = struct.Struct("<4sI80f")


def pack_state(sequence: int, at: float, imu: Floats, motors: Floats) -> bytes:
    """A state packet.

    Args:
        sequence: Number of the packet.
        at: Time of the state [s].
        imu: (6,) gyro and accelerometer.
        motors: (16, 3) q, dq and tau.
    """
    return _STATE.pack(b"SWS1", sequence & 0xFFFFFFFF, at, *imu.tolist(), *motors.ravel().tolist())


def unpack_command(packet: bytes) -> tuple[int, Floats]:
    """Sequence of the state that it answers, and q, dq, tau, kp, kd of the motors (16, 5).

    Raises:
        ValueError: If it is no command.
    """
    if len(packet) != _COMMAND.size or packet[:4] != b"SWC1":
        raise ValueError("not a command packet")
    _, sequence, *numbers = _COMMAND.unpack(packet)
    return sequence, np.array(numbers).reshape(MOTORS, 5)


@dataclass(frozen=True)
class Played:
    """What a player made of a plan.

    Attributes:
        outcome: As of a rollout; `stopped` where the player gave up and the robot stands.
        reason: One sentence about it.
        time: Of the simulation, from the first state to the last command [s].
        end_error: Largest distance of a wheel from the plan's end [m].
        pitch_max: Largest pitch on the way, whatever its sign [rad].
        torque_peak: Largest torque that acted at thigh or calf, and at a wheel [Nm].
        states: How many states were sent.
    """

    outcome: Outcome
    reason: str
    time: float
    end_error: float
    pitch_max: float
    torque_peak: tuple[float, float]
    states: int


class LowLevelRobot:
    """A robot in MuJoCo with 16 motors and an IMU.

    Args:
        plan: Where it starts, and on which terrain.
        friction: Coulomb friction of the ground; the plan's by default.
        model: The robot's own MJCF or URDF file, simulated in the place of our model of it.
        seed: Of the sensors' noise.
        noise: Of the sensors, 1 for usual ones.
    """

    def __init__(
        self,
        plan: Plan,
        friction: float | None = None,
        model: str | os.PathLike[str] | None = None,
        seed: int = 0,
        noise: float = 1.0,
    ) -> None:
        truth = plan.friction if friction is None else as_friction(friction)
        given = (plan, truth, Disturbance(), seed)
        physics = OwnPhysics(*given) if model is None else OriginalPhysics(model, *given)
        self.run = Run(plan, truth, ControllerSettings(), Disturbance(), seed, 100.0, physics)
        self.dt = self.run.dt
        built = robot = plan.robot_description
        self._sensors = _core.RobotSensors(robot.native, _core.SensorErrors(noise), seed)
        self._torques = np.zeros(12)
        self._signs, self._offsets = robot.ros_frames
        self._motor_of, self._facing = MOTOR_OF, np.ones(6)
        if plan.facing == "backward":  # its motors and its IMU are as they were built
            built = turned(robot)
            self._motor_of = MOTOR_OF[[JOINTS.index(opposite(joint)) for joint in JOINTS]]
            self._facing = np.array([-1.0, -1.0, 1.0] * 2)
        self._abduction = _Abduction(built, physics)
        self.peak = np.zeros(2)

    def sense(self) -> tuple[Floats, Floats]:
        """Gyro and accelerometer (6,), and q, dq and tau of the motors (16, 3)."""
        data = self.run.data
        joints, rates, torques, gyro, force = self._sensors.read(
            np.ascontiguousarray(data.qpos), np.ascontiguousarray(data.qvel), self._torques, self.dt
        )
        motors = np.zeros((MOTORS, 3))
        motors[self._motor_of, 0] = self._signs * (np.array(joints) - self._offsets)
        motors[self._motor_of, 1] = self._signs * np.array(rates)
        motors[self._motor_of, 2] = self._signs * np.array(torques)
        motors[ABDUCTION_OF] = self._abduction.state()
        return self._facing * np.array([*gyro, *force]), motors

    def act(self, command: Floats) -> None:
        """One control step with what the motors are told (16, 5)."""
        data, own = self.run.data, command[self._motor_of]
        q, dq = self._signs * (data.qpos[7:] - self._offsets), self._signs * data.qvel[6:]
        wanted = own[:, 2] + own[:, 3] * (own[:, 0] - q) + own[:, 4] * (own[:, 1] - dq)
        rates = np.ascontiguousarray(data.qvel[6:])
        self._torques = _core.limit_torques(self.run.robot.native, rates, self._signs * wanted)
        data.ctrl[:12] = self._torques
        self._abduction.act(command[ABDUCTION_OF])
        size = np.abs(self._torques).reshape(4, 3)
        self.peak = np.maximum(self.peak, [size[:, :2].max(), size[:, 2].max()])
        self.run.touch(self.run.time)
        self.run.physics.advance()
        self.run.time += self.dt


class _Abduction:
    """The abduction motors of a robot's own model; ours has none, and they stand where they are."""

    def __init__(self, robot: Robot, physics: Physics) -> None:
        self.joints = np.zeros((0, 3), int)
        lean = robot.abduction
        self._fixed = np.array([[lean if leg[1] == "L" else -lean, 0.0, 0.0] for leg in LEGS])
        self._torques = np.zeros(4)
        if not isinstance(physics, OriginalPhysics):
            return
        self._data = physics.state.data
        reading, model = physics.reading, physics.original.model
        held = list(reading.held)
        joints, most = [], []
        for leg in LEGS:
            j = reading.legs[leg].chain.abduction
            if j is None:
                raise InputError(f"{leg} has no abduction joint", ("model",))
            actuator = 12 + held.index(j)
            joint = int(model.actuator_trnid[actuator, 0])
            joints.append((actuator, model.jnt_qposadr[joint], model.jnt_dofadr[joint]))
            most.append(robot.motors[3 * LEGS.index(leg)].torque)
            # The player holds it, not a servo of ours.
            model.actuator_biasprm[actuator] = 0.0
            model.actuator_gainprm[actuator, 0] = 1.0
        self.joints, self._most = np.array(joints), np.array(most)

    def state(self) -> Floats:
        """(4, 3) q, dq and tau, FL, FR, RL, RR."""
        if not len(self.joints):
            return self._fixed
        _, q, dq = self.joints.T
        return np.stack([self._data.qpos[q], self._data.qvel[dq], self._torques], axis=1)

    def act(self, command: Floats) -> None:
        if not len(self.joints):
            return
        q, dq, _ = self.state().T
        goal, rate, torque, kp, kd = command.T
        wanted = torque + kp * (goal - q) + kd * (rate - dq)
        self._torques = np.clip(wanted, -self._most, self._most)
        self._data.ctrl[self.joints[:, 0]] = self._torques


def play(
    robot: LowLevelRobot,
    player: tuple[str, int],
    *,
    limit: float = 120.0,
    patience: float = 20.0,
) -> Played:
    """Let the player at the address `player` drive `robot` until it stops doing so.

    Args:
        robot: At its start.
        player: Address and port where it listens.
        limit: Longest time of the simulation [s].
        patience: How long an answer may take [s].

    Raises:
        InputError: If no player answers.
    """
    run, sequence, pitch_max = robot.run, 0, 0.0
    planned = [pose.pitch for pose in run.plan.poses]
    lowest, highest = min(planned), max(planned)
    cause = ("timeout", "")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        link.connect(player)
        while run.time < limit:
            sequence += 1
            state = pack_state(sequence, run.time, *robot.sense())
            command = _ask(link, state, sequence, patience)
            if command is None and sequence == 1:
                raise InputError(f"no player answers at {player[0]}:{player[1]}", ("port",))
            if command is None:
                cause = ("stuck", "")
                break
            if not command[:, 2:4].any():  # only damped
                cause = ("arrived", "")
                break
            robot.act(command)
            roll, pitch = _attitude(run)
            pitch_max = max(pitch_max, abs(pitch))
            beyond = pitch - min(max(pitch, lowest), highest)
            why = fallen(beyond, roll, float(run.data.qpos[2]), run.floor)
            if why:
                cause = ("fell", why)
                break
    return _judged(robot, cause, pitch_max, sequence)


def _ask(link: socket.socket, state: bytes, sequence: int, patience: float) -> Floats | None:
    """The command that answers a state; None if there is none for `patience` [s]."""
    until = time.monotonic() + patience
    while (left := until - time.monotonic()) > 0.0:
        try:
            link.settimeout(left)
            link.send(state)
            answered, command = unpack_command(link.recv(1024))
            while answered != sequence:
                answered, command = unpack_command(link.recv(1024))
            return command
        except ConnectionRefusedError:  # nobody listens there, yet or any more
            if sequence > 1:
                return None
            time.sleep(_RETRY)
        except TimeoutError:
            return None
    return None


def _attitude(run: Run) -> tuple[float, float]:
    """Size of the roll, and pitch [rad]."""
    w, x, y, z = run.data.qpos[3:7]
    roll = abs(math.asin(max(-1.0, min(1.0, 2 * (y * z + w * x)))))
    return roll, math.atan2(2 * (x * z + w * y), 1 - 2 * (x * x + y * y))


def _judged(robot: LowLevelRobot, cause: tuple[str, str], pitch_max: float, states: int) -> Played:
    run = robot.run
    wheels = run.physics.wheels()
    real, drawn = run.physics.terrain, run.plan.terrain
    error = end_error(run.plan, drawn, real, run.disturbance, wheels, own_sensors=True)
    first, last = run.plan.poses[0].x_c, run.plan.poses[-1].x_c
    way = (float(run.data.qpos[0]) - first, last - first)
    ending = Ending(cause[0], run.time, way, error, cause[1])
    outcome, reason = judge(ending, run.loads, run.robot.mass * GRAVITY)
    leg, wheel = robot.peak.tolist()
    return Played(outcome, reason, run.time, error, pitch_max, (leg, wheel), states)
