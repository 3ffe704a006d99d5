"""Refusals for want of torque, judged by a search that shares nothing with the planner.

Where planning says "needs leg torque 123 Nm, has 80 Nm", random poses are drawn for every place
of the front and rear wheels along the profile: own kinematics, statics with friction and motors,
and geometry (shapely). Places where one of them can stand are joined to the next ones. Poses may
change at once between places, legs may cross, and links are half as thick as they are: the search
errs in favour of the robot. A refusal is

    confirmed   if even so no way leads to the end,
    open        if one does: a plan would still have to come past what the search leaves out.

Questions are those of `random_robots.py` with motors of 0.25 to 0.9 of their torque.

python benchmarks/torque_refusals.py [--first 0] [--count 200] [--processes 2] [--quick] [--json F]
    --count: refusals that name a torque, not questions
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from itertools import count, islice
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray
from refusals import question

import stairwright as sw

Floats = NDArray[np.float64]
GRAVITY = 9.81
STEP = 0.03  # of the wheels along their curve, over the robot's reach
PAST = 1e-3  # m; as near to a corner of the curve it is looked at
SAMPLES = 200_000  # poses of the legs, shared by all places
LOOKED_AT = (300, 3000)  # of them at one place: first, and where none of these stands
NEAR = 2e-3  # m between the distance of two places and that of the wheels
THIN = 0.5  # of a link's radius, as thick as it is taken
TILT = 1.3  # rad, most pitch


@dataclass(frozen=True)
class Places:
    """Where one pair of wheels can stand: (n, 2) centres and contact points [m]."""

    centres: Floats
    contacts: Floats


def ground(points: Floats) -> shapely.Polygon:
    """What lies below a profile."""
    low = points[:, 1].min() - 5.0
    return shapely.Polygon([*points, (points[-1, 0], low), (points[0, 0], low)])


def places(points: Floats, radius: float, step: float) -> Places:
    """Along the curve of wheel centres above a profile."""
    rim = np.array(shapely.buffer(ground(points), radius, quad_segs=32).exterior.coords)
    if not shapely.LinearRing(rim).is_ccw:
        rim = rim[::-1]
    # From the right end over the top to the left one, turned round.
    first = int(np.argmin(np.hypot(*(rim - points[-1] - (0.0, radius)).T)))
    rim = np.roll(rim[:-1], -first, axis=0)
    last = int(np.argmin(np.hypot(*(rim - points[0] - (0.0, radius)).T)))
    curve = rim[: last + 1][::-1]
    line = shapely.LineString(curve)
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(curve, axis=0).T))])
    ahead = np.diff(curve, axis=0)
    before, after = ahead[:-1], ahead[1:]
    turns = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turns /= np.hypot(*before.T) * np.hypot(*after.T)
    inner = along[1:-1][turns > 0.05]
    stations = np.unique(
        np.concatenate([np.arange(0.0, line.length, step), inner - PAST, inner + PAST])
    )
    centres = shapely.get_coordinates(line.interpolate(stations.clip(0.0, line.length)))
    profile = shapely.LineString(points)
    ends = profile.interpolate(profile.project(shapely.points(centres)))
    return Places(centres, shapely.get_coordinates(ends))


def turned(angle: Floats, vector: Floats) -> Floats:
    """(n, 2) vectors after a rotation about +y, which takes x towards -z."""
    cos, sin = np.cos(angle), np.sin(angle)
    x, z = vector[..., 0], vector[..., 1]
    return np.stack([cos * x + sin * z, cos * z - sin * x], axis=-1)


@dataclass(frozen=True)
class Legs:
    """Random poses of both legs in the trunk's frame, sorted by the distance of their wheels."""

    joints: tuple[Floats, Floats]  # each (n, 3, 2): hip, knee, wheel
    masses: tuple[Floats, Floats]  # each (n, 2, 2): mass centres of thigh and calf
    span: Floats  # (n,)


def draw(robot: sw.Robot, random: np.random.Generator) -> Legs:
    joints, masses = [], []
    for leg in robot.legs:
        thigh = random.uniform(*leg.limits.thigh, SAMPLES)
        calf = thigh + random.uniform(*leg.limits.calf, SAMPLES)
        hip = np.broadcast_to(np.array(leg.hip), (SAMPLES, 2))
        knee = hip + turned(thigh, np.array([0.0, -leg.thigh.length]))
        wheel = knee + turned(calf, np.array([0.0, -leg.calf.length]))
        joints.append(np.stack([hip, knee, wheel], axis=1))
        centres = (
            hip + turned(thigh, np.array(leg.thigh.com)),
            knee + turned(calf, np.array(leg.calf.com)),
        )
        masses.append(np.stack(centres, axis=1))
    span = np.hypot(*(joints[0][:, 2] - joints[1][:, 2]).T)
    order = np.argsort(span)
    return Legs(
        (joints[0][order], joints[1][order]), (masses[0][order], masses[1][order]), span[order]
    )


def moment(arm: Floats, force: Floats) -> Floats:
    """About +y [Nm]."""
    return arm[..., 1] * force[..., 0] - arm[..., 0] * force[..., 1]


class Search:
    """Where a robot can stand on a profile without the planner's help."""

    def __init__(self, robot: sw.Robot, points: Floats, friction: float) -> None:
        self.robot, self.points, self.friction = robot, points, friction
        reach = max(leg.reach for leg in robot.legs)
        self.rows = [places(points, leg.wheel.radius, STEP * reach) for leg in robot.legs]
        self.legs = draw(robot, np.random.default_rng(0))
        self.solid = ground(points)
        shapely.prepare(self.solid)

    def stands(self, front: int, rear: int) -> bool:
        """Whether some pose with the wheels at two places is balanced, strong and clear."""
        gap = self.rows[0].centres[front] - self.rows[1].centres[rear]
        if gap[0] <= 0.0:
            return False
        low, high = np.searchsorted(self.legs.span, np.hypot(*gap) + np.array([-NEAR, NEAR]))
        return any(
            self._some_stand((front, rear), np.linspace(low, high - 1, min(n, high - low)), gap)
            for n in LOOKED_AT
            if high > low
        )

    def _some_stand(self, at: tuple[int, int], chosen: Floats, gap: Floats) -> bool:
        poses = chosen.astype(int)
        between = self.legs.joints[0][poses, 2] - self.legs.joints[1][poses, 2]
        pitch = np.arctan2(between[:, 1], between[:, 0]) - np.arctan2(gap[1], gap[0])
        pitch = (pitch + np.pi) % (2 * np.pi) - np.pi
        trunk = self.rows[1].centres[at[1]] - turned(pitch, self.legs.joints[1][poses, 2])
        joints, masses = (
            [trunk[:, None] + turned(pitch[:, None], part[poses]) for part in parts]
            for parts in (self.legs.joints, self.legs.masses)
        )
        fine = np.abs(pitch) < TILT
        for point in (trunk, *(joint[:, k] for joint in joints for k in (0, 1))):
            fine &= point[:, 1] > np.interp(point[:, 0], *self.points.T)
        fine &= self._balanced(at, trunk, pitch, joints, masses)
        return bool(self._clear(trunk[fine], pitch[fine], [joint[fine] for joint in joints]).any())

    def _clear(self, trunk: Floats, pitch: Floats, joints: list[Floats]) -> NDArray[np.bool_]:
        """Whether neither the trunk nor a link of (n,) poses is in the ground."""
        free = np.ones(len(trunk), bool)
        for piece in self.robot.body.outline:
            corners = trunk[:, None] + turned(pitch[:, None], np.array(piece.points))
            free &= ~shapely.intersects(self.solid, shapely.polygons(corners))
        for leg, joint in zip(self.robot.legs, joints, strict=True):
            for k, link in enumerate((leg.thigh, leg.calf)):
                line = shapely.linestrings(joint[:, k : k + 2])
                free &= ~shapely.dwithin(self.solid, line, THIN * link.radius)
        return free

    def _balanced(
        self, at: tuple[int, int], trunk: Floats, pitch: Floats, joints: list[Floats],
        masses: list[Floats],
    ) -> NDArray[np.bool_]:  # fmt: skip
        """Whether forces within friction and motors carry (n,) poses with wheels at two places.

        Two forces of two components keep three equations. One number is free in each pose, how
        hard the wheels press against each other, and every bound is linear in it.
        """
        contacts = [row.contacts[k] for row, k in zip(self.rows, at, strict=True)]
        arm = contacts[0] - contacts[1]
        if not arm.any():  # both on one corner
            return np.zeros(len(trunk), bool)
        weights = [
            2.0 * GRAVITY * np.array([leg.thigh.mass, leg.calf.mass, leg.wheel.mass])
            for leg in self.robot.legs
        ]
        com = np.array([self.robot.body.com[0], self.robot.body.com[2]])
        own = GRAVITY * self.robot.body.mass
        total = own + sum(weight.sum() for weight in weights)
        lever = own * (trunk + turned(pitch, com))[:, 0] - total * contacts[1][0]
        carried = [  # x of what hangs on each leg: thigh, calf, wheel
            np.concatenate([mass[:, :, 0], joint[:, 2:, 0]], axis=1)
            for mass, joint in zip(masses, joints, strict=True)
        ]
        for weight, x in zip(weights, carried, strict=True):
            lever = lever + x @ weight
        # About the rear contact the front force has the weight's moment.
        needed = lever[:, None] * np.array([-arm[1], arm[0]]) / (arm @ arm)
        forces = needed, np.array([0.0, total]) - needed
        bounds = Bounds(len(trunk))
        for k, leg in enumerate(self.robot.legs):
            force, grow = forces[k], (1 - 2 * k) * arm
            up = self.rows[k].centres[at[k]] - contacts[k]
            n = up / np.hypot(*up)
            for t in (np.array([n[1], -n[0]]), np.array([-n[1], n[0]])):
                bounds.keep(force @ (self.friction * n - t), grow @ (self.friction * n - t))
            for m, motor in enumerate(leg.motors):
                reach = contacts[k] - joints[k][:, m]
                hangs = carried[k][:, m:] - joints[k][:, m, None, 0]
                torque = moment(reach, force) + hangs @ weights[k][m:]
                slope = moment(reach, grow)
                for sign in (1.0, -1.0):
                    bounds.keep(2.0 * motor.torque - sign * torque, -sign * slope)
        return bounds.exist

    def arrives(self) -> bool:
        """Whether places where it stands lead from the first to the last flat."""
        front, rear = (row.centres[:, 0] for row in self.rows)
        begins, ends = self.points[1, 0], self.points[-2, 0]
        flat = begins - max(leg.wheel.radius for leg in self.robot.legs) - PAST
        first = range(int(np.searchsorted(front, flat)))
        queue = [(i, 0) for i in first if self.stands(i, 0)]
        seen = set(queue)
        while queue:
            i, j = queue.pop()
            if rear[j] > ends:
                return True
            for near in ((i + a, j + b) for a in (1, 0, -1) for b in (1, 0, -1)):
                inside = 0 <= near[0] < len(front) and 0 <= near[1] < len(rear)
                if inside and near not in seen:
                    seen.add(near)
                    if self.stands(*near):
                        queue.append(near)
        return False


class Bounds:
    """Bounds on one free number in each of n poses."""

    def __init__(self, n: int) -> None:
        self.low, self.high = np.full(n, -np.inf), np.full(n, np.inf)

    def keep(self, offset: Floats, slope: Floats | float) -> None:
        """offset + slope * free >= 0."""
        rises = np.broadcast_to(slope, offset.shape)
        steep = np.abs(rises) > 1e-12
        edge = -offset / np.where(steep, rises, 1.0)
        self.low = np.where(steep & (rises > 0), np.maximum(self.low, edge), self.low)
        self.high = np.where(steep & (rises < 0), np.minimum(self.high, edge), self.high)
        self.high = np.where(~steep & (offset < 0.0), -np.inf, self.high)

    @property
    def exist(self) -> NDArray[np.bool_]:
        return self.low <= self.high


def examine(seed: int) -> dict[str, Any] | None:
    """What the search says of one refusal; None if there is none that names a torque."""
    points, document, friction = question(seed)
    weaker = np.random.default_rng(seed).uniform(0.25, 0.9)
    for motors in (document["actuators"], (document.get("rear") or {}).get("actuators") or {}):
        for motor in motors.values():
            if motor:
                motor |= {"torque": motor["torque"] * weaker, "continuous": None}
    robot = sw.Robot.model_validate(document)
    plan = sw.plan({"points": points}, robot, friction)
    limit = plan.problem.limit if plan.problem else None
    if limit is None or plan.problem is None or "torque" not in limit.quantity:
        return None
    mu = limit.given.get("friction", friction)  # it needs both
    arrives = Search(plan.robot_description, np.array(points), mu).arrives()
    return {"seed": seed, "message": plan.problem.message, "confirmed": not arrives}


def judged(first: int, processes: int) -> Iterator[dict[str, Any]]:
    with ProcessPoolExecutor(processes) as pool:
        batch = 4 * processes
        for begin in count(first, batch):
            yield from filter(None, pool.map(examine, range(begin, begin + batch)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--quick", action="store_true", help="two refusals")
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    rows = []
    for row in islice(
        judged(options.first, options.processes), 2 if options.quick else options.count
    ):
        rows.append(row)
        told = "confirmed" if row["confirmed"] else "open"
        print(f"{row['seed']}: {told}: {row['message']}", flush=True)
    print(f"{sum(row['confirmed'] for row in rows)} of {len(rows)} refusals confirmed")
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    main()
