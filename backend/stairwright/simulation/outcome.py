"""The verdict on a rollout, as the contract defines it.

``success``: all four wheels within 2 cm of where the plan ends, upright, no link loaded.
``diverged``: the numbers left the finite. ``fell``: the trunk turned over or left the plan's pitch
by a radian, or the robot dropped off the terrain. ``collided``: trunk or a link carried load, or
legs touched each other.
``stopped``: the robot gave up by itself, stood still and says why (sensing robot).
``stuck``: no progress for some seconds, or at rest short of the end. ``timeout``: still moving when
the time was over.

A link grazes while the load that it takes stays below a share of the weight, averaged over 20 ms so
that a light tap does not count as carrying.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from .result import Outcome

ARRIVED = 0.02  # m, every wheel
TURNED_OVER = 1.0  # rad, roll or deviation from the plan's pitch
DROP = 0.3  # m below the lowest point of the terrain
STUCK_TIME = 4.0  # s
STUCK_PROGRESS = 0.005  # m
GRAZE_SHARE = 0.05  # of the weight
LOAD_TIME = 0.02  # s
_HUGE = 1e6  # N; larger forces come from states that are about to diverge


@dataclass
class LinkLoads:
    """Loads of trunk and links on the terrain, averaged over `LOAD_TIME`.

    Attributes:
        peak: Largest averaged load of any link [N].
        where: That link, and the time [s].
        contacts: Control steps with a link on the terrain.
        self_contacts: Control steps with legs touching each other.
        touched: The parts that did so first, and the time [s].
    """

    dt: float
    loads: dict[str, float] = field(default_factory=dict)
    peak: float = 0.0
    where: tuple[str, float] = ("", 0.0)
    contacts: int = 0
    self_contacts: int = 0
    touched: tuple[tuple[str, ...], float] = ((), 0.0)

    def add(self, time: float, forces: dict[str, float], own: tuple[str, ...] = ()) -> None:
        """Book one control step.

        Args:
            time: [s].
            forces: Of the terrain by link name [N]; empty when none touches.
            own: Two parts of the robot that touch each other, if any.
        """
        if own:
            self.touched = self.touched if self.self_contacts else (own, time)
            self.self_contacts += 1
        share = self.dt / LOAD_TIME
        if forces:
            self.contacts += 1
        for name in {*self.loads, *forces}:
            old = self.loads.get(name, 0.0)
            load = old + share * (min(forces.get(name, 0.0), _HUGE) - old)
            self.loads[name] = load
            if load > self.peak:
                self.peak, self.where = load, (name, time)
        self.loads = {name: load for name, load in self.loads.items() if load > 1e-3}


@dataclass
class ProgressWatch:
    """Notices when the plan has not advanced for `STUCK_TIME`."""

    best: float = -math.inf
    since: float = 0.0

    def stuck(self, time: float, progress: float) -> bool:
        """Whether `progress` has stood still for too long."""
        if progress > self.best + STUCK_PROGRESS:
            self.best, self.since = progress, time
        return time - self.since > STUCK_TIME


@dataclass(frozen=True)
class Ending:
    """How a rollout's loop ended.

    Attributes:
        cause: What stopped the loop.
        time: When [s].
        progress: The plan's progress then, and the plan's whole length [m].
        error: Largest distance of a wheel from the plan's end [m].
        detail: Words for the reason.
    """

    cause: str
    time: float
    progress: tuple[float, float]
    error: float
    detail: str = ""


def fallen(pitch_error: float, roll: float, z: float, floor: float) -> str:
    """Why the robot counts as fallen; empty while it does not."""
    if abs(pitch_error) > TURNED_OVER:
        way = "backward" if pitch_error < 0 else "forward"
        return f"tipped {way}, {math.degrees(abs(pitch_error)):.0f}° from the planned pitch"
    if roll > TURNED_OVER:
        return f"rolled over sideways by {math.degrees(roll):.0f}°"
    if z < floor - DROP:
        return "dropped off the end of the terrain"
    return ""


def judge(ending: Ending, loads: LinkLoads, weight: float) -> tuple[Outcome, str]:
    """The outcome and one sentence about it."""
    done, total = ending.progress
    where = f"at {ending.time:.1f} s, {done:.2f} m of {total:.2f} m along the plan"
    rest = "" if ending.cause == "arrived" else f" The run ended {where}."
    if ending.cause == "diverged":
        return "diverged", f"The simulation left finite numbers {where}."
    if ending.cause == "fell":
        return "fell", f"The robot {ending.detail} {where}."
    if loads.peak > GRAZE_SHARE * weight:
        link, time = loads.where
        return "collided", f"{_words(link)} carried {loads.peak:.0f} N at {time:.1f} s.{rest}"
    if ending.cause == "stopped":
        return "stopped", f"The robot stopped {where}, and stands: {ending.detail}."
    if loads.self_contacts:
        parts, time = loads.touched
        first, second = map(_words, sorted(parts))
        return "collided", f"{first} and {second.lower()} touched each other at {time:.1f} s.{rest}"
    if ending.cause == "arrived" and ending.error <= ARRIVED:
        grazes = f"; a link grazed for {loads.contacts} control steps" if loads.contacts else ""
        return "success", f"Arrived after {ending.time:.1f} s{grazes}."
    if ending.cause == "timeout":
        return "timeout", f"Still under way {where}."
    if ending.cause == "arrived":
        return "stuck", f"At rest {100 * ending.error:.1f} cm from where the plan ends."
    return "stuck", f"No progress for {STUCK_TIME:.0f} s {where}."


def _words(link: str) -> str:
    legs = {"FL": "front left", "FR": "front right", "RL": "rear left", "RR": "rear right"}
    leg, _, part = link.partition("_")
    return f"The {legs[leg]} {part}" if part else f"The {link}"
