"""Form ``contact`` of the controller, compiled: the same torques as `controller.Controller`.

One call a control step, no allocation outside it, everything in flat arrays. The numpy form is the
reference: a test compares both on random states. Read that one first; names are the same.
"""

from __future__ import annotations

import math

import numba as nb
import numpy as np
from numpy.typing import NDArray

from stairwright.robot.description import Robot

from . import balance, rigid_body
from .contact import locate, support, wheel_traction
from .controller import gains
from .qp import solve_native
from .setpoint import LEANS, RATES, SHARE, SURGES
from .settings import ControllerSettings

Floats = NDArray[np.float64]

_MAX_ACCELERATION = balance.MAX_ACCELERATION
_GRAVITY = rigid_body.GRAVITY
_PERIOD, _MAX_LEARNT = balance.CONTROL_PERIOD, balance.MAX_LEARNT
_EVEN, _MOST_UNEVEN = balance.EVEN, balance.MOST_UNEVEN
_Q, _PITCH, _COM, _FORCE = 2, 6, 7, 22

_NAMES = (
    "hip_front_x",
    "hip_front_z",
    "hip_rear_x",
    "hip_rear_z",
    "half_track",
    "thigh",
    "calf",
    "radius",
    "mass",
    "trunk_mass",
    "thigh_mass",
    "calf_mass",
    "wheel_mass",
    "thigh_com",
    "calf_com",
    "trunk_inertia",
    "leg_inertia",
    "friction",
    "friction_share",
    "joint_stiffness",
    "joint_damping",
    "wheel_damping",
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
    "force_limit",
    "leg_torque",
    "leg_speed",
    "wheel_torque",
    "wheel_speed",
)
PARAMETERS = np.dtype([(name, float) for name in _NAMES])
"""Everything constant during a rollout. SI units."""


def parameters(robot: Robot, friction: float, settings: ControllerSettings) -> NDArray[np.void]:
    """One record of `PARAMETERS`, as an array of length 1."""
    own = gains(robot, settings)
    values = {
        "hip_front_x": robot.hips.front[0],
        "hip_front_z": robot.hips.front[1],
        "hip_rear_x": robot.hips.rear[0],
        "hip_rear_z": robot.hips.rear[1],
        "half_track": robot.hips.half_track,
        "thigh": robot.thigh.length,
        "calf": robot.calf.length,
        "radius": robot.wheel.radius,
        "mass": robot.mass,
        "trunk_mass": robot.trunk.mass,
        "thigh_mass": robot.thigh.mass,
        "calf_mass": robot.calf.mass,
        "wheel_mass": robot.wheel.mass,
        "thigh_com": robot.thigh.com,
        "calf_com": robot.calf.com,
        "trunk_inertia": robot.trunk.inertia[1],
        "leg_inertia": robot.thigh.inertia[1] + robot.calf.inertia[1] + robot.wheel.inertia[1],
        "friction": friction,
        "joint_stiffness": own.joint_stiffness,
        "joint_damping": own.joint_damping,
        "wheel_damping": own.wheel_damping,
        "force_limit": own.force_limit,
        "leg_torque": robot.actuators.leg.torque,
        "leg_speed": robot.actuators.leg.speed,
        "wheel_torque": robot.actuators.wheel.torque,
        "wheel_speed": robot.actuators.wheel.speed,
    }
    record = np.zeros(1, dtype=PARAMETERS)
    for name in _NAMES:
        record[name] = values[name] if name in values else getattr(settings, name)
    return record


@nb.njit(cache=True)
def contact_control(
    record: NDArray[np.void],
    pieces: Floats,
    corners: Floats,
    qpos: Floats,
    qvel: Floats,
    target: Floats,
    yaw_rate: float,
    places: Floats,
    forces: Floats,
    learnt: Floats,
    torques: Floats,
) -> None:
    """Torques (12,) before the motors' limits; updates the memory in place.

    `record` is of `parameters`, `pieces` and `corners` of the `WheelPath`, `qpos` (19,) and `qvel`
    (18,) are measured, `target` (33,) is a row in the order of `setpoint`, `yaw_rate` is commanded.
    The memory is `places` (4,), `forces` (8,) and `learnt` (1,).
    """
    p = record[0]
    R = p.radius
    w, x, y, z = qpos[3], qpos[4], qpos[5], qpos[6]
    r00, r01, r02 = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
    r20, r21, r22 = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)
    r11 = 1 - 2 * (x * x + z * z)
    sx, sy, sz = qvel[3], qvel[4], qvel[5]
    pitch, heading = math.atan2(r02, r22), math.atan2(-r01, r11)
    turning = r20 * sx + r21 * sy + r22 * sz

    # Points in the trunk frame: hip, knee, wheel, each x, z; mass centre, its rate, inertia.
    body = np.empty((4, 6))
    cx = cz = vx = vz = moment2 = 0.0
    for i in range(4):
        hx, hz = (p.hip_front_x, p.hip_front_z) if i < 2 else (p.hip_rear_x, p.hip_rear_z)
        j = 7 + 3 * i
        a, b = qpos[j], qpos[j] + qpos[j + 1]
        da, db = qvel[j - 1], qvel[j - 1] + qvel[j]
        sa, ca, sb, cb = math.sin(a), math.cos(a), math.sin(b), math.cos(b)
        ux, uz, lx, lz = -p.thigh * sa, -p.thigh * ca, -p.calf * sb, -p.calf * cb
        uvx, uvz, lvx, lvz = (
            -p.thigh * ca * da,
            p.thigh * sa * da,
            -p.calf * cb * db,
            p.calf * sb * db,
        )
        body[i, 0], body[i, 1] = hx, hz
        body[i, 2], body[i, 3] = hx + ux, hz + uz
        body[i, 4], body[i, 5] = hx + ux + lx, hz + uz + lz
        upper = p.thigh_mass * p.thigh_com + p.calf_mass + p.wheel_mass
        lower = p.calf_mass * p.calf_com + p.wheel_mass
        leg = p.thigh_mass + p.calf_mass + p.wheel_mass
        cx += leg * hx + upper * ux + lower * lx
        cz += leg * hz + upper * uz + lower * lz
        vx += upper * uvx + lower * lvx
        vz += upper * uvz + lower * lvz
        tx, tz = hx + p.thigh_com * ux, hz + p.thigh_com * uz
        fx, fz = hx + ux + p.calf_com * lx, hz + uz + p.calf_com * lz
        moment2 += p.thigh_mass * (tx * tx + tz * tz) + p.calf_mass * (fx * fx + fz * fz)
        moment2 += p.wheel_mass * (body[i, 4] ** 2 + body[i, 5] ** 2)
    cx, cz, vx, vz = cx / p.mass, cz / p.mass, vx / p.mass, vz / p.mass
    inertia = moment2 - p.mass * (cx * cx + cz * cz) + p.trunk_inertia + 4 * p.leg_inertia
    com_x, com_z = qpos[0] + r00 * cx + r02 * cz, qpos[2] + r20 * cx + r22 * cz
    # Velocity of the mass centre in the trunk frame: spin x place + its own rate.
    bx, by, bz = sy * cz + vx, sz * cx - sx * cz, -sy * cx + vz
    com_vx = qvel[0] + r00 * bx + r01 * by + r02 * bz
    com_vz = qvel[2] + r20 * bx + r21 * by + r22 * bz

    usable = max(p.friction_share, target[SHARE]) * p.friction
    # World points (x, z), faces, and the map from contact forces to the body's wrench (eqs 3-7).
    world = np.empty((4, 6))
    held = np.empty((4, 8))
    friction = np.empty(4)
    A = np.empty((3, 8))
    for i in range(4):
        side = p.half_track if i % 2 == 0 else -p.half_track
        for k in range(3):
            px, pz = body[i, 2 * k], body[i, 2 * k + 1]
            world[i, 2 * k] = qpos[0] + r00 * px + r01 * side + r02 * pz
            world[i, 2 * k + 1] = qpos[2] + r20 * px + r21 * side + r22 * pz
        places[i] = locate(pieces, R, world[i, 4], world[i, 5], places[i])
        planned, lean = target[i // 2], int(target[LEANS.start + i // 2])
        support(pieces, R, corners, places[i], planned, usable, lean, held[i])
        nx, nz, friction[i], reach = held[i, 0], held[i, 1], held[i, 2], held[i, 3]
        lx, lz = world[i, 4] - reach * nx - com_x, world[i, 5] - reach * nz - com_z
        A[0, 2 * i], A[1, 2 * i], A[2, 2 * i] = nz, -nx, lz * nz + lx * nx
        A[0, 2 * i + 1], A[1, 2 * i + 1], A[2, 2 * i + 1] = nx, nz, lz * nx - lx * nz

    # Desired wrench (eqs 8-9) and the QP (eqs 11-12).
    ax = target[SURGES + 1] + p.com_stiffness * (target[_COM] - com_x)
    ax += p.com_damping * (target[RATES + _COM] - com_vx)
    ax = min(max(ax, -_MAX_ACCELERATION), _MAX_ACCELERATION)
    az = target[SURGES + 2] + p.com_stiffness * (target[_COM + 1] - com_z)
    az += p.com_damping * (target[RATES + _COM + 1] - com_vz)
    learnt[0] += _PERIOD * p.pitch_integral * (target[_PITCH] - pitch)
    learnt[0] = min(max(learnt[0], -_MAX_LEARNT), _MAX_LEARNT)
    spin = learnt[0] + target[SURGES] + p.pitch_stiffness * (target[_PITCH] - pitch)
    spin += p.pitch_damping * (target[RATES + _PITCH] - sy)
    S = (p.force_weight, p.force_weight, p.moment_weight)
    b = (S[0] * p.mass * ax, S[1] * p.mass * (az + _GRAVITY), S[2] * inertia * spin)
    H, g = np.empty((8, 8)), np.empty(8)
    for i in range(8):
        for j in range(i + 1):
            H[i, j] = S[0] * A[0, i] * A[0, j] + S[1] * A[1, i] * A[1, j] + S[2] * A[2, i] * A[2, j]
            H[j, i] = H[i, j]
        H[i, i] += p.alpha + p.beta + _EVEN
        fx, fz = 0.5 * target[_FORCE + 2 * (i // 4)], 0.5 * target[_FORCE + 2 * (i // 4) + 1]
        nx, nz = held[i // 2, 0], held[i // 2, 1]
        resting = fx * nz - fz * nx if i % 2 == 0 else fx * nx + fz * nz
        g[i] = -A[0, i] * b[0] - A[1, i] * b[1] - A[2, i] * b[2]
        g[i] -= p.alpha * resting + p.beta * forces[i]
    height = com_z - 0.25 * (world[0, 5] + world[1, 5] + world[2, 5] + world[3, 5]) + R
    roll = p.roll_stiffness * r21 + p.roll_damping * (r22 * sx - r20 * sz)
    carried = max(target[_FORCE + 1], 0.0) + max(target[_FORCE + 3], 0.0)
    share = -p.mass * height * height * roll / p.half_track / max(carried, 1e-9)
    share = min(max(share, -_MOST_UNEVEN), _MOST_UNEVEN)
    for i in (0, 1, 4, 5):  # left and right wheel of a pair
        H[i, i + 2] -= _EVEN
        H[i + 2, i] -= _EVEN
        if i % 2 == 1:
            uneven = max(target[_FORCE + 2 * (i // 4) + 1], 0.0) * share
            g[i] -= _EVEN * uneven
            g[i + 2] += _EVEN * uneven
    solve_native(H, g, friction, p.force_limit, forces)

    # Torques: J' F and the legs' weight, tracking (eq 27), rolling (eqs 14-16) with feed-forward.
    wanted = yaw_rate - p.heading_stiffness * heading
    difference = p.half_track / R * (wanted + p.yaw_damping * (wanted - turning))
    for i in range(4):
        pair = i // 2
        nx, nz, reach = held[i, 0], held[i, 1], held[i, 3]
        t, n = forces[2 * i], forces[2 * i + 1]
        fx, fz = t * nz + n * nx, n * nz - t * nx
        hx, hz, kx, kz, wx, wz = world[i]
        px, pz = wx - reach * nx, wz - reach * nz
        thigh_x = p.thigh_com * (kx - hx)
        calf_x = p.calf_com * (wx - kx)
        carried = p.thigh_mass * thigh_x + p.calf_mass * (kx - hx + calf_x)
        carried += p.wheel_mass * (wx - hx)
        below = p.calf_mass * calf_x + p.wheel_mass * (wx - kx)
        j, q, rate = 3 * i, _Q + 2 * pair, RATES + _Q + 2 * pair
        torques[j] = (
            (px - hx) * fz
            - (pz - hz) * fx
            - _GRAVITY * carried
            + p.joint_stiffness * (target[q] - qpos[7 + j])
            + p.joint_damping * (target[rate] - qvel[6 + j])
        )
        torques[j + 1] = (
            (px - kx) * fz
            - (pz - kz) * fx
            - _GRAVITY * below
            + p.joint_stiffness * (target[q + 1] - qpos[8 + j])
            + p.joint_damping * (target[rate + 1] - qvel[7 + j])
        )
        speed = target[RATES + pair] + p.wheel_sync * (target[pair] - places[i])
        wheel = speed / R + (-difference if i % 2 == 0 else difference)
        rolled = qvel[6 + j] + qvel[7 + j] + qvel[8 + j] + sy
        torques[j + 2] = R * wheel_traction(held[i], fx, fz) + p.wheel_damping * (wheel - rolled)
