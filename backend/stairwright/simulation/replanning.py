"""Another plan on the way, where what the robot finds is not what its plan believes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from stairwright.control.setpoint import SHARE
from stairwright.errors import InputError
from stairwright.planning.firm_margins import firm_com_margins
from stairwright.planning.path import plan_path
from stairwright.planning.plan import Plan, PlanTiming
from stairwright.planning.planner import plan as make_plan
from stairwright.planning.standing import StandingPose
from stairwright.planning.tolerance import Tolerance
from stairwright.planning.weights import parse_weights
from stairwright.robot.description import Robot
from stairwright.robot.parts import Payload
from stairwright.terrain.profile import Terrain

from .governor import Track

MOTION = 1.25  # of the friction at rest, that is needed in motion
TESTED = 0.9  # of the friction that the plan needs: more than that is not asked for in the test
ENOUGH = 0.75  # of it; with less there is no going on where no other plan is found
LEAST = 0.2  # friction on which no robot is sent: what is known of it is too rough
# Of the friction that was found, what another plan may need: with the motion where there is such a
# plan, else at rest.
USABLE = (1.0 / MOTION, 0.9)
ABOVE = 0.05  # m above the trunk's top, of the mass centre of a load whose height is not known

KEPT = 0.003  # m of room for a mass centre that is elsewhere than planned: it is found to 2 mm

Point = tuple[float, float]  # (x, z)


def tested_friction(line: Track, plan: Plan) -> float:
    """The friction to test the ground for before the start; 0 where there is nothing to fear."""
    needed = TESTED * needed_friction(line, plan)
    return needed if needed >= LEAST else 0.0


def needed_friction(line: Track, plan: Plan) -> float:
    """The friction that the plan needs: that of its static forces, and some for the motion."""
    return min(1.0, MOTION * float(line.rows[:, SHARE].max())) * plan.least_friction


@dataclass(frozen=True)
class Decision:
    """What to do: follow `plan`, or where there is none and `why` is empty, go on.

    Attributes:
        plan: Another plan.
        why: Why to stop instead.
    """

    plan: Plan | None = None
    why: str = ""


def plan_anew(
    old: Plan, terrain: Terrain, friction: float, robot: Robot | None = None
) -> Plan | None:
    """A plan of the same kind over `terrain` with `friction`; None where there is none.

    It has the old one's tolerance, or none where there is no plan with that.
    """
    for tolerance in _tolerances(old, friction):
        try:
            new = make_plan(
                terrain,
                robot or old.robot_description,
                friction,
                old.method,
                old.weights or None,
                timing=_timing(old),
                tolerance=tolerance,
                facing="forward",  # the end that leads already
                diagnose=False,
            )
        except InputError:
            continue
        if new.feasible:
            return new.model_copy(update={"facing": old.facing})
    return None


def plan_onward(old: Plan, terrain: Terrain, here: StandingPose, progress: float) -> Plan | None:
    """A path over `terrain` that begins at `here`, or near to it; None where there is none.

    Args:
        old: The plan that is followed.
        terrain: The map.
        here: Where the robot is.
        progress: How far along the old plan that is [m]; the new one goes on from there.
    """
    if old.method != "path":
        return None
    for tolerance in _tolerances(old, old.friction):
        new = plan_path(
            terrain,
            [old.robot_description],
            old.friction,
            parse_weights("path", old.weights or None),
            timing=_timing(old),
            tolerance=tolerance,
            diagnose=False,
            here=here,
        )
        if new.feasible:
            moved = [p.model_copy(update={"progress": progress + p.progress}) for p in new.poses]
            return new.model_copy(update={"facing": old.facing, "poses": moved})
    return None


def _loses_tolerance(old: Plan, new: Plan) -> bool:
    """Where the old plan holds as well, it has more to spare than such a new one."""
    return old.tolerance is not None and new.tolerance is None


def _tolerances(old: Plan, friction: float) -> Iterator[Tolerance | None]:
    """What another plan is asked to stand, the first that can be had."""
    if old.tolerance is not None:
        known = friction != old.friction  # it was measured
        yield old.tolerance.model_copy(update={"friction": 0.0}) if known else old.tolerance
    yield None


def _timing(plan: Plan) -> PlanTiming:
    """How a plan is timed that takes its place."""
    return "fast" if plan.timing.rule == "fast" else "steady"


def after_slip(plan: Plan, need: float, found: float, *, front: bool) -> Decision:
    """What to do after a test of the grip in which wheels slipped at the friction `found`."""
    if found >= TESTED * need:
        return Decision()
    stands = plan.tolerance is not None and found >= TESTED * plan.least_friction
    for usable in USABLE if found >= LEAST else ():
        new = plan_anew(plan, plan.terrain, usable * found)
        if new is not None and not (stands and _loses_tolerance(plan, new)):
            return Decision(new)
    if stands or found >= ENOUGH * need:
        return Decision()
    pair = "front" if front else "rear"
    return Decision(
        why=f"the {pair} wheels slipped at a friction of {found:.2f} before the start, the plan "
        f"needs {need:.2f} and there is none for less"
    )


def laden(robot: Robot, mass: float, place: Point) -> Robot:
    """The robot with a load of `mass` [kg] beside the payload that it has.

    Args:
        robot: Without the load.
        mass: Of the load.
        place: Of its mass centre in the trunk's frame [m]; on top where z is not a number.
    """
    x, z = place
    if math.isnan(z):
        z = robot.body.top(x)[1] + ABOVE
    own = robot.payload
    if own is not None:
        share = mass / (mass + own.mass)
        x, z = (share * p + (1.0 - share) * q for p, q in zip((x, z), own.place, strict=True))
        mass += own.mass
    return _changed(robot, payload=Payload(mass=mass, place=(x, z)))


def balanced_at(robot: Robot, shift: Point) -> Robot:
    """The robot with its mass centre shifted in the trunk's frame [m]."""
    x, y, z = robot.trunk.com
    share = robot.mass / robot.trunk.mass
    com = (x + share * shift[0], y, z + share * shift[1])
    return _changed(robot, trunk=robot.trunk.model_copy(update={"com": com}))


def _changed(robot: Robot, **parts: object) -> Robot:
    # Documents of the first schema have neither a payload nor a mass centre off the middle.
    return robot.model_copy(update={"schema_": "stairwright/robot/2", **parts})


def after_weighing(plan: Plan, mass: float, place: Point, shift: Point) -> Decision:
    """What to do where the robot weighs other than its plan is for.

    Args:
        plan: Which it is about to follow.
        mass: That it carries [kg], and
        place: where, see `laden`; or, where that mass is 0,
        shift: of its mass centre, see `balanced_at`.
    """
    robot = plan.robot_description
    found = laden(robot, mass, place) if mass else balanced_at(robot, shift)
    new = plan_anew(plan, plan.terrain, plan.friction, found)
    if new is not None and (mass or not _loses_tolerance(plan, new)):
        return Decision(new)
    if mass:
        return Decision(
            why=f"the robot weighs {found.mass:.1f} kg, {mass:.1f} kg more than the plan is for, "
            "and there is none for that"
        )
    lacking = KEPT - float(firm_com_margins(plan, shift).min())
    if lacking <= 0.0:
        return Decision()
    if new is not None:
        return Decision(new)
    return Decision(
        why=f"the robot's mass centre is {1e3 * math.hypot(*shift):.0f} mm from where the plan has "
        f"it, so that it would lack {1e3 * lacking:.0f} mm of balance, and there is none for that"
    )
