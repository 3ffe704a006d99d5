"""Robots nobody has built: random ones on random profiles, planned, certified and rolled out.

Each is one of the presets with every dimension changed by a factor of 0.5 to 2 (links, trunk,
wheels, motors; masses with the cube of the size), its mass centre moved by up to 20 % of the
distance of its hips, knees of any kind, and a payload of up to 30 % of its mass; profiles are those
of `profiles.py`, scaled to the robot's legs.

With `--unlike`, parts of a robot that usually go together do not: legs and wheels of a tenth to
three times their mass, rotors of up to five times their inertia or none, slow and fast motors, a
narrow or wide track, rear legs that differ from the front ones.

With `--varied` the friction is one of 0.35 to 1.1, and half of the plans have weights from a
thirtieth to 30.

python benchmarks/random_robots.py [--first 0] [--count 100] [--unlike] [--varied] [--timing fast]
    [--processes 2] [--json FILE]
"""

from __future__ import annotations

import argparse
import json
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from copy import deepcopy
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from profiles import random_profile

import stairwright as sw

PRESETS = ("a1_wheeled", "a1_wheeled_x", "go2w", "b2w", "m20", "d1", "anymal_wheels")


def factor(random: np.random.Generator, most: float = 2.0) -> float:
    return float(most ** random.uniform(-1.0, 1.0))


def changed_link(link: dict[str, Any], length: float, mass: float) -> dict[str, Any]:
    def scaled(point: Any) -> list[float]:
        return [point[0] * length, point[1] * length]

    com = link["com"]
    return link | {
        "length": link["length"] * length,
        "mass": link["mass"] * mass,
        "com": scaled(com) if isinstance(com, (list, tuple)) else com,
        "inertia": [moment * mass * length**2 for moment in link["inertia"]],
        "shape": [
            piece | {"start": scaled(piece["start"]), "end": scaled(piece["end"])}
            for piece in link.get("shape", [])
        ],
    }


def heavier(part: dict[str, Any], ratio: float) -> dict[str, Any]:
    """A link or a wheel of `ratio` times the density."""
    return part | {"mass": part["mass"] * ratio, "inertia": [i * ratio for i in part["inertia"]]}


def unlike_parts(data: dict[str, Any], seed: int) -> None:
    """Change parts of a robot's document one by one, in place."""
    random = np.random.default_rng([1, seed])
    legs = float(10.0 ** random.uniform(-1.0, 0.5))
    for name in ("thigh", "calf", "wheel"):
        data[name] = heavier(data[name], legs * factor(random, 1.5))
    rotors = 0.0 if random.random() < 0.1 else factor(random, 5.0)
    for motor in data["actuators"].values():
        if motor is None:
            continue
        motor["armature"] = min(motor["armature"] * rotors, 10.0)
        motor["damping"] = min(motor["damping"] * factor(random, 3.0), 10.0)
        motor["speed"] = min(motor["speed"] * factor(random), 1000.0)
    data["wheel"]["radius"] *= factor(random, 1.4)
    data["hips"]["half_track"] *= factor(random, 1.4)
    rise = 0.25 * data["trunk"]["size"][2] * float(random.uniform(-1.0, 1.0))
    x = data["hips"]["front"][0]
    data["hips"] |= {"front": (x, rise), "rear": (-x, -rise)}
    tumbling = factor(random, 1.4)
    data["trunk"]["inertia"] = [i * tumbling for i in data["trunk"]["inertia"]]
    if random.random() < 0.5:
        rear = {name: deepcopy(data[name]) for name in ("thigh", "calf", "wheel", "actuators")}
        for name in ("thigh", "calf"):
            rear[name] = heavier(
                changed_link(rear[name], factor(random, 1.2), 1.0), factor(random, 1.5)
            )
        rear["wheel"] = heavier(rear["wheel"], factor(random, 1.5))
        for motor in rear["actuators"].values():
            if motor is not None:
                motor["torque"] = min(motor["torque"] * factor(random, 1.3), 1000.0)
        data["rear"] = rear


def random_robot(seed: int, unlike: bool = False) -> sw.Robot:
    """A robot by its seed; see above."""
    random = np.random.default_rng(seed)
    data = sw.load_robot(PRESETS[seed % len(PRESETS)]).model_dump()
    data |= {"schema": "stairwright/robot/2", "name": f"random {seed}"}
    data |= {"gains": None, "collision_points": None}
    size = factor(random)
    thigh, calf = size * factor(random, 1.4), size * factor(random, 1.4)
    heavy = size**3 * factor(random, 1.5)
    wide = size * factor(random, 1.5)
    for name, ratio in (("thigh", thigh), ("calf", calf)):
        data[name] = changed_link(data[name], ratio, heavy)
        data[name]["radius"] *= size
        for piece in data[name]["shape"]:
            piece["radius"] *= size
    ratio = size * factor(random, 1.3)
    wheel = data["wheel"]
    data["wheel"] = wheel | {
        "radius": wheel["radius"] * ratio, "width": wheel["width"] * ratio,
        "mass": wheel["mass"] * heavy, "inertia": [i * heavy * ratio**2 for i in wheel["inertia"]],
    }  # fmt: skip
    trunk, high = data["trunk"], size * factor(random, 1.5)
    hip = data["hips"]["front"][0] * wide
    data["hips"] |= {"front": [hip, 0.0], "rear": [-hip, 0.0]}
    data["hips"]["half_track"] *= size
    data["trunk"] = trunk | {
        "size": [trunk["size"][0] * wide, trunk["size"][1] * size, trunk["size"][2] * high],
        "mass": trunk["mass"] * heavy,
        "inertia": [i * heavy * max(wide, high) ** 2 for i in trunk["inertia"]],
        "com": [float(random.uniform(-0.2, 0.2)) * 2 * hip * 0.5, 0.0,
                float(random.uniform(-0.2, 0.2)) * trunk["size"][2] * high],
        "outline": [
            piece | {"points": [(x * wide, z * high) for x, z in piece["points"]]}
            for piece in trunk.get("outline", [])
        ],
    }  # fmt: skip
    for motor in data["actuators"].values():
        motor["torque"] = min(motor["torque"] * size * heavy * factor(random, 1.5), 1000.0)
        motor["armature"] *= heavy * size**2
        motor["damping"] = min(motor["damping"] * heavy * size**2, 10.0)
    if random.random() < 0.3:  # odd knees
        low, high_end = 0.5, 2.6
        for pair in ("front", "rear"):
            forward = random.random() < 0.5
            data["joints"][pair] = {
                "thigh": (-4.2, 1.2) if forward else (-1.2, 4.2),
                "calf": (low, high_end) if forward else (-high_end, -low),
            }
    if unlike:
        unlike_parts(data, seed)
    reach = data["thigh"]["length"] + data["calf"]["length"]
    data["nominal_height"] = data["wheel"]["radius"] + reach * float(random.uniform(0.6, 0.8))
    if random.random() < 0.5:
        mass = sw.Robot.model_validate(data).mass * float(random.uniform(0.02, 0.3))
        data["payload"] = {"mass": mass, "place": [0.3 * hip, 0.6 * data["trunk"]["size"][2]]}
    return sw.Robot.model_validate(data)


def varied(seed: int) -> dict[str, Any]:
    """Friction and weights of a plan."""
    random = np.random.default_rng([7, seed])
    weights = {}
    friction = float(random.choice([0.35, 0.5, 0.7, 0.9, 1.1]))
    if random.random() < 0.5:
        for name in ("com_margin", "clearance", "torque", "smoothness", "pitch"):
            if random.random() < 0.5:
                weights[name] = factor(random, 30.0)
    return {"friction": friction, "weights": weights}


def one(seed: int, options: argparse.Namespace) -> dict[str, Any]:
    robot = random_robot(seed, options.unlike)
    kind, terrain = random_profile(seed)
    scale = min(leg.reach for leg in robot.legs) / 0.4
    begun = time.perf_counter()
    asked = varied(seed) if options.varied else {"friction": 0.6}
    points = [(x * scale, z * scale) for x, z in terrain.points]
    plan = sw.plan({"points": points}, robot, timing=options.timing, **asked)
    row = {
        "seed": seed, "kind": kind, "like": PRESETS[seed % len(PRESETS)], "planned": plan.feasible,
        "seconds": time.perf_counter() - begun, "binding": plan.binding and plan.binding.quantity,
    }  # fmt: skip
    if plan.problem is not None:
        return row | {"outcome": plan.problem.kind, "message": plan.problem.message}
    run = sw.rollout(plan)
    return row | {
        "certified": sw.certify(plan).passed, "outcome": run.outcome,
        "message": "" if run.outcome == "success" else run.reason,
        "contacts": run.metrics.link_contacts,
    }  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--unlike", action="store_true")
    parser.add_argument("--varied", action="store_true")
    parser.add_argument("--timing", choices=("steady", "fast"), default="steady")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    seeds = range(options.first, options.first + options.count)
    with ProcessPoolExecutor(options.processes) as pool:
        rows = []
        for row in pool.map(partial(one, options=options), seeds):
            rows.append(row)
            if row["outcome"] != "success" or not row["certified"]:
                print(row, flush=True)
    planned = [row for row in rows if row["planned"]]
    good = sum(row["outcome"] == "success" for row in planned)
    refused = [row["seconds"] for row in rows if not row["planned"]]
    print(f"{len(rows)} robots, {len(planned)} plans, {good} succeed")
    print("outcomes:", dict(Counter(row["outcome"] for row in rows)))
    print("binding:", dict(Counter(row["binding"] for row in planned)))
    for name, times in (("plan", [row["seconds"] for row in planned]), ("refusal", refused)):
        if times:
            print(f"{name}: p50 {np.median(times):.3f} s, p95 {np.percentile(times, 95):.3f} s")
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
