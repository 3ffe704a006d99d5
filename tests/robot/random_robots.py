"""Robots of the second schema that are unlike in everything: front and rear, thigh and calf."""

import numpy as np

from stairwright.library import load_robot
from stairwright.robot.description import Robot


def _link(random, length):
    lower = (0.0, -length)
    elbow = (float(random.uniform(-0.05, 0.05)), float(-random.uniform(0.2, 0.8) * length))
    return {
        "length": length,
        "radius": 0.012,
        "mass": float(random.uniform(0.2, 3.0)),
        "com": [float(random.uniform(-0.03, 0.03)), float(random.uniform(-length, 0.03))],
        "inertia": [0.01, 0.011, 0.002],
        "shape": [
            {"start": (0.0, 0.0), "end": elbow, "radius": 0.012},
            {"start": elbow, "end": lower, "radius": 0.008},
        ],
    }


def _motors(random):
    motor = {"speed": 20.0, "armature": 0.01, "damping": 0.05}
    return {
        part: motor | {"torque": float(random.uniform(20.0, 60.0))}
        for part in ("thigh", "calf", "wheel")
    }


def random_robot(seed: int) -> Robot:
    """No two numbers alike, a trunk of two pieces, a payload, one knee forward and one back."""
    random = np.random.default_rng(seed)
    thigh, calf = random.uniform(0.16, 0.26, 2), random.uniform(0.16, 0.26, 2)
    hip = float(random.uniform(0.11, 0.2))
    hip_z = float(random.uniform(-0.02, 0.02))
    length, height = 2 * hip, float(random.uniform(0.08, 0.12))
    x, z = length / 2, height / 2
    nose = [(x, -z / 2), (x + 0.04, -z / 4), (x + 0.04, z / 3), (x, z / 2)]
    data = load_robot("a1_wheeled").model_dump() | {
        "schema": "stairwright/robot/2",
        "name": f"random {seed}",
        "nominal_height": 0.05 + 0.75 * float(min(thigh + calf)),
        "trunk": {
            "size": [length, 0.2, height],
            "mass": float(random.uniform(3.0, 12.0)),
            "inertia": [0.05, 0.12, 0.13],
            "com": [float(v) for v in random.uniform(-0.02, 0.02, 3) * (1, 0, 1)],
            "outline": [
                {"points": [(-x, -z), (x, -z), (x, z), (-x, z)], "width": 0.2},
                {"points": nose, "width": 0.1},
            ],
        },
        "payload": {"mass": float(random.uniform(0.1, 2.0)), "place": [0.02, 0.08]},
        "hips": {"front": [hip, hip_z], "rear": [-hip, -hip_z], "half_track": 0.16},
        "thigh": _link(random, float(thigh[0])),
        "calf": _link(random, float(calf[0])),
        "actuators": _motors(random),
        "rear": {
            "thigh": _link(random, float(thigh[1])),
            "calf": _link(random, float(calf[1])),
            "actuators": _motors(random),
        },
        "joints": {
            "front": {"thigh": [-4.0, 1.1], "calf": [0.7, 2.7]},
            "rear": {"thigh": [-1.1, 4.0], "calf": [-2.7, -0.8]},
        },
        "gains": None,
        "collision_points": None,
    }
    return Robot.model_validate(data)
