"""A plan as the player on a robot reads it (native/include/stairwright/player/plan_file.hpp)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from stairwright.control.controller import gains
from stairwright.control.native import OF_ROBOT, OF_SETTINGS
from stairwright.control.settings import ControllerSettings
from stairwright.errors import InputError
from stairwright.planning.plan import Plan
from stairwright.robot.description import JOINTS, LEGS, Robot
from stairwright.robot.legs import Leg, LinkForm
from stairwright.robot.parts import Actuator
from stairwright.robot.turning import Facing, opposite
from stairwright.simulation.governor import lead_of, plan_track
from stairwright.simulation.measured import SETTLE
from stairwright.simulation.replanning import ENOUGH, TESTED, needed_friction
from stairwright.terrain.wheel_path import wheel_path

MOTOR_LEGS = ("FR", "FL", "RR", "RL")  # how such robots number their motors
HOLD = 5.0  # times the legs' stiffness, at abduction joints: nothing else keeps a leg upright
SETTINGS = ControllerSettings(sensing="robot")


def player_plan(plan: Plan) -> str:
    """The text of a plan file.

    Raises:
        InputError: If the plan is infeasible; simulated robots may try such a plan, others not.
    """
    if not plan.feasible or not plan.executable:
        why = plan.problem.message if plan.problem else "the plan has no poses"
        raise InputError(f"not for a robot: {why}", ("plan",))
    robot = plan.robot_description
    lines = [
        "stairwright-player 1",
        f"# {robot.name} on {plan.terrain.name or 'a terrain'}; SI units and radians",
        f"plan {plan.id}",
        _line("friction", plan.least_friction),
        _line("facing", -1.0 if plan.facing == "backward" else 1.0),
        *_robot(robot),
        *_gains(robot),
        "# number, name, what it is: drive JOINT SIGN OFFSET, hold ANGLE, or none",
        *_motors(robot, plan.facing),
        *_course(plan, robot),
    ]
    return "\n".join(lines) + "\n"


def _robot(robot: Robot) -> Iterator[str]:
    body = robot.body
    yield _line("trunk", body.mass, body.inertia[1], body.com[0], body.com[2])
    yield _line("half_track", robot.hips.half_track)
    yield _line("nominal_height", robot.nominal_height)
    for name, leg in zip(("front", "rear"), robot.legs, strict=True):
        yield from (f"{name}.{line}" for line in _leg(leg))


def _leg(leg: Leg) -> Iterator[str]:
    yield _line("hip", *leg.hip)
    yield _line("thigh", *_link(leg.thigh))
    yield _line("calf", *_link(leg.calf))
    yield _line("wheel", leg.wheel.radius, leg.wheel.mass, leg.wheel.inertia[1])
    yield _line("thigh_range", *leg.limits.thigh)
    yield _line("calf_range", *leg.limits.calf)
    for part in ("thigh", "calf", "wheel"):
        motor: Actuator = getattr(leg, f"{part}_motor")
        yield _line(f"{part}_motor", motor.torque, motor.speed, motor.armature, motor.damping)
    yield _line("knee", leg.knee)


def _link(link: LinkForm) -> tuple[float, ...]:
    return 0.0, -link.length, *link.com, link.mass, link.inertia[1]


def _gains(robot: Robot) -> Iterator[str]:
    own = gains(robot, SETTINGS)
    for source, names in ((SETTINGS, OF_SETTINGS), (own, OF_ROBOT)):
        yield from (_line(f"gain.{name}", getattr(source, name)) for name in names)
    yield _line("hold", HOLD * own.joint_stiffness, own.joint_damping)


def _motors(robot: Robot, facing: Facing) -> Iterator[str]:
    """Abduction turns about x forward, so that a left leg leans outward where it is positive."""
    signs, offsets = robot.ros_frames

    def drive(number: int, joint: str) -> str:
        j = JOINTS.index(opposite(joint) if facing == "backward" else joint)
        role = _line("drive", j, signs[j], offsets[j])
        return f"motor {number} {robot.ros_joints[j]} {role}"

    for k, leg in enumerate(MOTOR_LEGS):
        outward = robot.abduction if leg[1] == "L" else -robot.abduction
        yield f"motor {3 * k} {leg}_hip {_line('hold', outward)}"
        yield drive(3 * k + 1, f"{leg}_thigh")
        yield drive(3 * k + 2, f"{leg}_calf")
    for k, leg in enumerate(MOTOR_LEGS):
        yield drive(3 * len(LEGS) + k, f"{leg}_wheel")


def _course(plan: Plan, robot: Robot) -> Iterator[str]:
    line = plan_track(plan, wheel_path(plan.terrain, robot.wheel.radius), SETTINGS)
    need = needed_friction(line, plan)
    yield "# way of the first row and between rows, lead over the wheels, rest before the start"
    yield _line("way", line.start)
    yield _line("step", line.step)
    yield _line("lead", lead_of(plan, SETTINGS))
    yield _line("settle", SETTLE)
    yield "# friction that the ground is tested for, and what will do"
    yield _line("grip", TESTED * need, ENOUGH * need)
    yield from (_line("vertex", *point) for point in plan.terrain.vertices.tolist())
    yield "# speed, then 41 numbers: see control/controller.hpp, Reference"
    for speed, row in zip(line.speeds.tolist(), line.rows.tolist(), strict=True):
        yield _line("row", speed, *row)


def _line(key: str, *values: float) -> str:
    return " ".join([key, *_numbers(values)])


def _numbers(values: Iterable[float]) -> Iterator[str]:
    """The shortest text that is the same number again, for all practical purposes."""
    return (f"{value:.10g}" for value in values)
