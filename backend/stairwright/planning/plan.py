"""The plan document: poses along the course, their margins, and what stops the robot."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Annotated, Any, Literal, Self

from pydantic import Field, PlainSerializer, model_validator

from stairwright.arguments import MOST_FRICTION
from stairwright.documents import Deferred, Model, content_hash, deferrable, save
from stairwright.errors import InputError
from stairwright.planning.problem import Problem, Vector2
from stairwright.planning.tolerance import Tolerance
from stairwright.robot.description import Robot
from stairwright.robot.turning import Facing
from stairwright.terrain.profile import Terrain

Method = Literal["path", "critical", "nominal"]
PlanTiming = Literal["steady", "fast"]
Vector4 = tuple[float, float, float, float]


class Margins(Model):
    """How far a pose is from failing. More is better; negative is violated."""

    clearance: float = Field(description="least distance of trunk and links from the terrain [m]")
    com: float = Field(description="CoM shift in x, the smaller way, that keeps equilibrium [m]")
    friction: float = Field(description="friction there is minus friction needed")
    torque: float = Field(description="limit minus the largest static joint torque [Nm]")


class Pose(Model):
    """One pose of the robot in the x-z plane; world frame, SI units."""

    progress: float = Field(
        description="way since the start, strictly rising, about the wheels' mean arc length [m]"
    )
    time: float = Field(0.0, description="planned time since the start [s]")
    x_c: float = Field(description="trunk point [m]")
    z_c: float = Field(description="trunk point [m]")
    pitch: float = Field(description="about +y: nose-up is negative [rad]")
    q: Vector4 = Field(description="front thigh, front calf, rear thigh, rear calf [rad]")
    wheels: tuple[Vector2, Vector2] = Field(description="wheel centres, front and rear [m]")
    wheel_progress: Vector2 = Field(description="arc length along the wheel-centre curve [m]")
    contacts: tuple[Vector2, Vector2] = Field(description="contact points, front and rear [m]")
    com: Vector2 = Field(description="centre of mass of the whole robot [m]")
    collision_points: list[Vector2] = Field(description="trunk, front leg, rear leg [m]")
    forces: tuple[Vector2, Vector2] | None = Field(
        None, description="static (tangential, normal) force of each wheel pair [N]"
    )
    margins: Margins


class Timing(Model):
    """Planned duration, and the time of every pose."""

    total: float = Field(description="[s]")
    rule: Literal["limits", "paper", "fast"] = Field(
        "limits",
        description="limits: steady, within limits of speed; paper: eqs 25-26; fast: time-optimal "
        "under dynamic limits",
    )
    limits: list[str] | None = Field(
        None, description="of a fast plan: at each pose what keeps it from being faster there"
    )


class Check(Model):
    """One line of the certificate: the worst value, the bound it must keep, and where."""

    name: str
    value: float
    bound: float
    unit: str
    passed: bool
    progress: float | None = Field(None, description="where the worst value stands [m]")


@deferrable("motion")
class Certificate(Model):
    """Outcome of the independent exact check of the poses and of the motion between them.

    The motion between sparse poses takes many times as long to judge as the poses: `motion` is
    found when it is first read, written or compared. The document always has it.
    """

    passed: bool
    scope: Literal["motion", "poses"] = "motion"
    motion: Annotated[
        Problem | None, PlainSerializer(Deferred.read, return_type=Problem | None)
    ] = Field(
        None, description="what stops the motion between poses, where only these are certified"
    )
    checks: list[Check] = []

    @classmethod
    def of_poses(cls, checks: list[Check], find_motion: Callable[[], Problem | None]) -> Self:
        """A certificate of poses; `find_motion` is asked once, when `motion` is needed."""
        passed = all(check.passed for check in checks)
        motion = Deferred(find_motion)
        return cls.trusted(passed=passed, scope="poses", motion=motion, checks=checks)

    def with_checks(self, checks: list[Check]) -> Certificate:
        """The same one with more checks, which have to pass too."""
        passed = self.passed and all(check.passed for check in checks)
        return self.model_copy(update={"checks": [*self.checks, *checks], "passed": passed})


Bend = Literal["back", "forward"]
FacingChoice = Literal["forward", "backward", "either"]  # either: as the planner finds better
Quantity = Literal["clearance", "com", "friction", "torque", "wheel_torque", "joint_limit"]


class Knees(Model):
    """Which way the knees bend in the plan of a robot whose knees bend both ways."""

    front: Bend
    rear: Bend


class Binding(Model):
    """The least margin, each taken against what it is a margin of, and where it is."""

    quantity: Quantity
    value: float = Field(description="m, Nm, rad, or of the friction")
    progress: float = Field(description="[m]")


class SaferFacing(Model):
    """Which end in front leaves clearly more of a thin margin, and the least of that plan."""

    facing: Facing
    by: Literal["com", "clearance"] = Field("com", description="the margin that is thin here")
    com_margin: float = Field(description="[m]")
    clearance: float | None = Field(None, description="from the robot to the terrain [m]")


# May be made when it is first read, written or compared.
Later = Annotated[float | None, PlainSerializer(Deferred.read, return_type=float | None)]


@deferrable("poses", "energy", "cost_of_transport")
class Plan(Model):
    """A plan (``stairwright/plan/1``); `id` is a hash of everything that went into it."""

    schema_: Literal["stairwright/plan/1"] = Field("stairwright/plan/1", alias="schema")
    id: str
    method: Method
    terrain: Terrain
    terrain_hash: str
    robot: str
    robot_hash: str
    robot_description: Robot
    friction: float = Field(gt=0.0, le=MOST_FRICTION)
    weights: dict[str, float] = {}
    status: Literal["feasible", "infeasible"]
    problem: Problem | None = None
    # Those of a path are made when they are first read, written or compared.
    poses: Annotated[list[Pose], PlainSerializer(Deferred.read, return_type=list[Pose])] = []
    critical: list[int] = Field([], description="indices of the key poses")
    timing: Timing
    solve_time: float = Field(description="[s]")
    certificate: Certificate | None = None
    knees: Knees | None = Field(None, description="where the robot's knees bend both ways")
    facing: Facing = Field(
        "forward",
        description="backward: the robot's rear leads, and `robot_description` and all poses are "
        "of the robot turned about, whose front legs are the rear ones of `robot`",
    )
    safer_facing: SaferFacing | None = Field(
        None,
        description="where the CoM's margin or the clearance is thin and the plan with the robot's "
        "other end in front leaves clearly more: that end, and its margins",
    )
    binding: Binding | None = Field(None, description="which margin is least")
    energy: Later = Field(
        None,
        description="of a dense feasible plan: sum of |static torque x turn| over all joints and "
        "poses, without dynamics, friction and losses [J]",
    )
    cost_of_transport: Later = Field(
        None, description="that energy per weight and way; null where there is none"
    )
    tolerance: Tolerance | None = Field(
        None,
        description="how far the world may be from what was drawn, where that was asked for; "
        "margins are then those at the lowest friction",
    )

    @model_validator(mode="after")
    def _in_order(self) -> Plan:
        for k, (a, b) in enumerate(itertools.pairwise(self.poses), 1):
            if b.progress <= a.progress:
                raise InputError("must be more than at the pose before", ("poses", k, "progress"))
            if b.time < a.time:
                raise InputError("must not be before the last pose's", ("poses", k, "time"))
        count = self.robot_description.points.count
        for k, pose in enumerate(self.poses):
            if len(pose.collision_points) != count:
                wrong = f"must be {count} points, as the robot has"
                raise InputError(wrong, ("poses", k, "collision_points"))
        for k, index in enumerate(self.critical):
            if not 0 <= index < len(self.poses):
                raise InputError("must be the index of a pose", ("critical", k))
        return self

    @property
    def feasible(self) -> bool:
        """Whether the robot can do it, as far as the planner and the certificate can tell."""
        return self.status == "feasible"

    @property
    def least_friction(self) -> float:
        """With which it still holds [1]: less than it was asked for by what its tolerance says."""
        return self.friction - (self.tolerance.friction if self.tolerance else 0.0)

    @property
    def executable(self) -> bool:
        """Whether it can be tried: a path that ends at an obstruction cannot."""
        return len(self.poses) >= 2 and (self.feasible or self.method != "path")

    def save(self, path: str, rate: float | None = None) -> None:
        """Write the plan; the ending of `path` picks the format.

        They are json, csv, npz, mcap, mjcf, urdf, and zip: a bundle for the robot.
        `rate` is that of the joint commands in MCAP [Hz].
        """
        save(self, path, rate)


def plan_id(
    terrain: Terrain,
    robot: Robot,
    friction: float,
    method: Method,
    weights: dict[str, Any],
    rule: str = "limits",
    tolerance: Tolerance | None = None,
    facing: Facing = "forward",
) -> str:
    """Content hash that names a plan: the same question has the same id.

    So has the one that leaves to the planner which end leads, with the end that it has chosen: the
    plan is the same.

    Names and descriptions belong to the question, for the plan repeats them.
    """
    texts = [terrain.name, terrain.description, robot.name, robot.description]
    key = [terrain.hash, robot.hash, *texts, friction, method, weights]
    if rule == "fast":
        key.append(rule)
    if tolerance is not None:
        key.append({"tolerance": tolerance.asked})
    if facing == "backward":
        key.append(facing)
    return "p-" + content_hash(key).removeprefix("sha256:")


def usual_facing(timing: PlanTiming) -> FacingChoice:
    """Which end leads where nothing is said of it."""
    return "either" if timing == "fast" else "forward"


def reach(plan: Plan) -> float:
    """How far a plan gets [m]; infinite where it is feasible."""
    return plan.problem.progress if plan.problem else math.inf
