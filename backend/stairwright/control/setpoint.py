"""One instant of the reference: what the controller is asked to do now."""

from __future__ import annotations

from dataclasses import dataclass

from stairwright.arrays import Floats
from stairwright.planning.poses.pose_reference import COM as COM
from stairwright.planning.poses.pose_reference import JOINTS as JOINTS
from stairwright.planning.poses.pose_reference import PITCH as PITCH
from stairwright.planning.poses.pose_reference import TRUNK as TRUNK
from stairwright.planning.poses.pose_reference import WHEELS as WHEELS

from .contact import BOTH

# Columns of a set point's row: what the plan asks for, its rates of change, its accelerations,
# static forces. Compiled code and reference tables use the same order.
RATES = 11  # the rate of column k is column RATES + k
ACCELERATIONS = 22  # likewise
FORCES = slice(33, 37)
SHARE = 37  # of the friction that the static forces need
PROGRESS = 38  # the plan's
LEANS = slice(39, 41)  # what each wheel pair leans on in a corner, see `contact`; not to be mixed
WIDTH = 41


@dataclass(frozen=True)
class Setpoint:
    """Desired state and its rates. SI units; pairs are front, rear.

    Attributes:
        wheel_progress: (2,) place of each wheel pair on the wheel-centre curve [m].
        q: (4,) planar joints [rad].
        pitch: [rad].
        com: (2,) centre of mass [m].
        trunk: (2,) trunk point [m].
        wheel_speed: (2,) along the wheel-centre curve [m/s].
        q_rate: (4,) [rad/s].
        pitch_rate: [rad/s].
        com_velocity: (2,) [m/s].
        trunk_velocity: (2,) [m/s].
        forces: (2, 2) static force of each wheel pair, world x and z [N].
        accelerations: (11,) of the first eleven, in the order of a row.
        friction_share: part of the friction that the static forces need.
        leans: (2,) what each wheel pair leans on in a corner, see `contact`.
    """

    wheel_progress: Floats
    q: Floats
    pitch: float
    com: Floats
    trunk: Floats
    wheel_speed: Floats
    q_rate: Floats
    pitch_rate: float
    com_velocity: Floats
    trunk_velocity: Floats
    forces: Floats
    accelerations: Floats
    friction_share: float = 0.0
    leans: tuple[int, int] = (BOTH, BOTH)

    @classmethod
    def from_row(cls, row: Floats) -> Setpoint:
        """The set point held by a row (41,) in the module's order."""
        rates = row[RATES : 2 * RATES]
        return cls(
            wheel_progress=row[WHEELS],
            q=row[JOINTS],
            pitch=float(row[PITCH]),
            com=row[COM],
            trunk=row[TRUNK],
            wheel_speed=rates[WHEELS],
            q_rate=rates[JOINTS],
            pitch_rate=float(rates[PITCH]),
            com_velocity=rates[COM],
            trunk_velocity=rates[TRUNK],
            forces=row[FORCES].reshape(2, 2),
            accelerations=row[ACCELERATIONS : ACCELERATIONS + RATES],
            friction_share=float(row[SHARE]),
            leans=(int(row[LEANS][0]), int(row[LEANS][1])),
        )
