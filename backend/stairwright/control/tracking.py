"""Joint tracking on top of the balance torques (eq 27)."""

from __future__ import annotations

from stairwright.arrays import Floats


def joint_torques(
    balance: Floats,
    stiffness: float,
    damping: float,
    q_desired: Floats,
    q: Floats,
    rate_desired: Floats,
    rate: Floats,
) -> Floats:
    """(4, 2) ``tau_QP + K_p (q* - q) + K_d (qdot* - qdot)`` of thighs and calves [Nm].

    `balance` is tau_QP (4, 2); `stiffness` K_p [Nm/rad]; `damping` K_d [Nm s/rad]; angles and rates
    (4, 2) are per leg: thigh, calf.
    """
    torques: Floats = balance + stiffness * (q_desired - q) + damping * (rate_desired - rate)
    return torques
