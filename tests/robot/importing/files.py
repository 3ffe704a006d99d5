"""Robot files written for the tests, with the quirks that makers' files have.

One robot, described by the side view's own numbers, is written as URDF or MJCF with whatever names,
axis signs and zero angles a test asks for. Nothing here uses the importer.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

LEGS = ("FL", "FR", "RL", "RR")


@dataclass(frozen=True)
class LegQuirks:
    """How one leg's joints count.

    `sign` and `zero` of abduction, thigh, calf and wheel: the axis points the other way, and the
    joint is at 0 where the link is turned by `zero` [rad].
    """

    sign: tuple[int, int, int, int] = (1, 1, 1, 1)
    zero: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Design:
    """A robot as it is meant."""

    name: str = "maker"
    hip: tuple[float, float, float] = (0.21, 0.06, 0.02)  # abduction axis of FL; others mirrored
    trunk_off: tuple[float, float] = (0.03, 0.04)  # of the hips' middle in the base's frame, x z
    side: float = 0.09  # from abduction axis to the leg's plane
    thigh: float = 0.22
    shank: tuple[float, float] = (0.05, -0.24)  # wheel in the calf's frame, bent forward
    radius: float = 0.08
    thigh_range: tuple[float, float] = (-1.2, 2.9)  # absolute, ours
    calf_range: tuple[float, float] = (-2.6, -0.7)  # ours, from the straight leg
    base_mass: float = 7.0
    base_com: tuple[float, float, float] = (0.02, 0.001, -0.004)
    quirks: dict[str, LegQuirks] = field(default_factory=dict)
    names: dict[str, str] = field(default_factory=dict)
    head: bool = True
    wheel_mesh: bool = False
    keyframe: bool = True
    frames: tuple[float, float] = (0.0, 0.0)  # turn of the thigh's and calf's link frames

    @property
    def bend(self) -> float:
        """Angle of the line from knee to wheel in the calf's own frame."""
        return math.atan2(-self.shank[0], -self.shank[1])

    @property
    def calf(self) -> float:
        """From knee to wheel [m]."""
        return math.hypot(*self.shank)

    def leg(self, name: str) -> LegQuirks:
        """Quirks of a leg."""
        return self.quirks.get(name, LegQuirks())

    def joint(self, leg: str, part: str) -> str:
        """A joint's name in the file."""
        return self.names.get(f"{leg}_{part}", f"{leg}_{part}_joint")

    def range_of(self, leg: str, part: str) -> tuple[float, float]:
        """A joint's range as the file counts."""
        k = 1 if part == "thigh" else 2
        quirk = self.leg(leg)
        ends = self.thigh_range if part == "thigh" else self.calf_range
        # ours = angle of the link; the calf's own frame differs from the line by the bend.
        turn = 0.0 if part == "thigh" else self.bend
        values = [quirk.sign[k] * (end - turn - quirk.zero[k]) for end in ends]
        return min(values), max(values)

    def theirs(self, leg: str, part: str, ours: float) -> float:
        """A joint's angle in the file where it is `ours` by the contract."""
        k = {"thigh": 1, "calf": 2, "wheel": 3}[part]
        turn = self.bend if part == "calf" else 0.0
        quirk = self.leg(leg)
        return quirk.sign[k] * (ours - turn - quirk.zero[k])


def mirrored(design: Design, leg: str) -> tuple[float, float, float]:
    """Where a leg's abduction axis is in the base's frame."""
    x, y, z = design.hip
    return (
        (x if leg[0] == "F" else -x) + design.trunk_off[0],
        y if leg[1] == "L" else -y,
        z + design.trunk_off[1],
    )


def parts(design: Design, leg: str) -> list[dict]:
    """The movable bodies of a leg from the trunk outward.

    Each: place and turn (about x for the first, y for the others) in its parent at joint angle 0,
    axis, mass, mass centre, moments, shapes.
    """
    quirk, out = design.leg(leg), 1.0 if leg[1] == "L" else -1.0
    fore = 1.0 if leg[0] == "F" else -1.0
    a, b = design.frames
    place = [mirrored(design, leg), (0.0, out * design.side, 0.0), turn_y((0, 0, -design.thigh), a),
             turn_y((design.shank[0], out * 0.03, design.shank[1]), b)]  # fmt: skip
    # A link's frame may be turned against the link: by -a for the thigh, -b for the calf.
    turns = [quirk.zero[0], quirk.zero[1] - a, quirk.zero[2] + a - b, quirk.zero[3] + b]
    bodies = []
    for k, part in enumerate(("hip", "thigh", "calf", "wheel")):
        axis = (quirk.sign[k], 0, 0) if k == 0 else (0, quirk.sign[k], 0)
        bodies.append(
            {
                "part": part,
                "place": place[k],
                "turn": turns[k],
                "axis": axis,
                "about": "x" if k == 0 else "y",
            }
        )
    half = design.thigh / 2
    own = {
        "hip": (0.6, (-0.005 * fore, out * 0.02, 0.0), (0.0005, 0.0009, 0.0006), 0.0,
                [("cylinder", (0.045, 0.02), (0, out * 0.05, 0), (math.pi / 2, 0))]),
        "thigh": (1.1, (-0.004, -out * 0.02, -0.04), (0.0058, 0.0057, 0.001), a,
                  [("box", (0.02, 0.015, half), (0.005, 0, -half), (0, 0))]),
        "calf": (0.35, (0.012, 0.0, -0.12), (0.0012, 0.0011, 0.0002), b,
                 [("cylinder", (0.012, 0.06), (0.02, 0, -0.07), (0, -0.3)),
                  ("sphere", (0.015,), (0.055, 0, -0.16), (0, 0))]),
        "wheel": (0.55, (0.0, out * 0.004, 0.0), (0.0009, 0.0016, 0.0009), 0.0,
                  [("cylinder", (design.radius, 0.022), (0, 0, 0), (math.pi / 2, 0))]),
    }  # fmt: skip
    for body in bodies:
        mass, com, moments, frame, shapes = own[body["part"]]
        body |= {
            "mass": mass, "com": turn_y(com, frame), "moments": moments, "frame": frame,
            "shapes": [
                (kind, size, turn_y(at, frame), (roll, pitch + frame))
                for kind, size, at, (roll, pitch) in shapes
            ],
        }  # fmt: skip
    return bodies


def turn_y(vector: tuple[float, float, float], angle: float) -> tuple[float, float, float]:
    """A vector turned about y."""
    x, y, z = vector
    c, s = math.cos(angle), math.sin(angle)
    return c * x + s * z, y, -s * x + c * z


def scrambled(seed: int) -> Design:
    """A robot with random measures, names, signs and zero angles."""
    rng = np.random.default_rng(seed)

    def uniform(low: float, high: float) -> float:
        return float(rng.uniform(low, high))

    words = rng.permutation([f"{a}{b}" for a in "qwxz" for b in "äkrt_9 -/.:%+"[:12]]).tolist()
    names, quirks = {}, {}
    for leg in LEGS:
        for part in ("hip", "thigh", "calf", "wheel"):
            names[f"{leg}_{part}"] = f"{words.pop()}{rng.integers(1000)}"
        sign = tuple(int(rng.choice([-1, 1])) for _ in range(4))
        zero = (uniform(-0.5, 0.5), uniform(-3, 3), uniform(-3, 3), uniform(-3, 3))
        quirks[leg] = LegQuirks(sign, zero)
    return replace(
        Design(),
        name=f"fuzz-{seed}",
        hip=(uniform(0.1, 0.5), uniform(0.03, 0.1), uniform(-0.05, 0.05)),
        trunk_off=(uniform(-0.1, 0.1), uniform(-0.1, 0.1)),
        thigh=uniform(0.1, 0.4),
        shank=(uniform(-0.1, 0.1), -uniform(0.15, 0.4)),
        radius=uniform(0.05, 0.12),
        quirks=quirks,
        names=names,
        keyframe=False,
        frames=(uniform(-2, 2), uniform(-2, 2)),
    )
