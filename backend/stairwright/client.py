"""A small client for a running service; documents come back as the package's own models.

    with Client("http://localhost:8000") as service:
        plan = service.plan("single-stair-036", robot="a1_wheeled")
        run = service.rollout(plan_id=plan.id, progress=print)

A service that is busy (429, 503) says when to come back; the client does so by itself.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeVar

from stairwright.answers import JobState, ServiceError
from stairwright.connection import Connection, Progress, quoted
from stairwright.documents import Model, parse
from stairwright.planning.plan import FacingChoice, Method, Plan, PlanTiming
from stairwright.robot.description import Robot
from stairwright.robot.importing.report import Imported
from stairwright.terrain.profile import Terrain

if TYPE_CHECKING:
    from stairwright.simulation.margins_result import RobustMargins
    from stairwright.simulation.result import Rollout
    from stairwright.simulation.trials_result import Trials

M = TypeVar("M", bound=Model)

__all__ = ["Client", "JobState", "ServiceError"]


class Client(Connection):
    """One service, and its documents; methods raise `ServiceError` for an answer that says no."""

    # ------------------------------------------------------------------ terrains and robots

    def robots(self) -> list[Robot]:
        """All robots, presets first."""
        return [_saved(Robot, each) for each in self._json("GET", "/robots")]

    def robot(self, name: str) -> Robot:
        """One robot."""
        return _saved(Robot, self._json("GET", f"/robots/{quoted(name)}"))

    def save_robot(self, robot: Robot) -> Robot:
        """Save a robot under its name."""
        body = robot.model_dump(mode="json")
        return _saved(Robot, self._json("PUT", f"/robots/{quoted(robot.name)}", json=body))

    def delete_robot(self, name: str) -> None:
        """Remove a saved robot."""
        self._send("DELETE", f"/robots/{quoted(name)}")

    def import_robot(
        self, path: str | Path, *, hold: Mapping[str, float] | None = None, **fields: Any
    ) -> Imported:
        """The robot in a URDF or MJCF file, in a zip of one with its meshes, or in our YAML."""
        file = Path(path)
        files = {"file": (file.name, file.read_bytes())}
        fields["hold"] = [f"{joint}={position}" for joint, position in (hold or {}).items()]
        return parse(Imported, self._json("POST", "/robots/import", files=files, data=fields))

    def export_robot(self, name: str, file_format: str) -> bytes:
        """A robot as a file: yaml, json, urdf or mjcf."""
        return self._export("robots", name, file_format)

    def terrains(self) -> list[Terrain]:
        """All terrains, presets first."""
        return [_saved(Terrain, each) for each in self._json("GET", "/terrains")]

    def terrain(self, name: str) -> Terrain:
        """One terrain."""
        return _saved(Terrain, self._json("GET", f"/terrains/{quoted(name)}"))

    def save_terrain(self, terrain: Terrain) -> Terrain:
        """Save a terrain under its name."""
        body = terrain.model_dump(mode="json")
        return _saved(Terrain, self._json("PUT", f"/terrains/{quoted(terrain.name)}", json=body))

    def delete_terrain(self, name: str) -> None:
        """Remove a saved terrain."""
        self._send("DELETE", f"/terrains/{quoted(name)}")

    def generate_terrain(self, kind: Literal["stair", "ramp", "flat"], **measures: Any) -> Terrain:
        """A terrain from a few measures."""
        return _saved(
            Terrain, self._json("POST", "/terrains/generate", json={"kind": kind, **measures})
        )

    def import_terrain(self, path: str | Path, **fields: Any) -> Terrain:
        """The profile in a file: STL, OBJ, PLY, OFF, CSV, JSON or YAML."""
        file = Path(path)
        files = {"file": (file.name, file.read_bytes())}
        return _saved(Terrain, self._json("POST", "/terrains/import", files=files, data=fields))

    def settings(self) -> dict[str, Any]:
        """JSON Schemas of weights and controller settings."""
        return dict(self._json("GET", "/settings"))

    # ------------------------------------------------------------------ plans

    def plan(
        self,
        terrain: str | Terrain | Mapping[str, Any],
        robot: str | Robot | Mapping[str, Any] = "a1_wheeled",
        friction: float | None = None,
        method: Method = "path",
        weights: Mapping[str, float] | None = None,
        timing: PlanTiming = "steady",
        tolerance: Mapping[str, float] | None = None,
        facing: FacingChoice | None = None,
    ) -> Plan:
        """Plan; an infeasible terrain gives a plan with a problem, no error."""
        body = {**_question(terrain, robot, friction, method, weights), "timing": timing}
        if facing is not None:
            body["facing"] = facing
        if tolerance:
            body["tolerance"] = dict(tolerance)
        return parse(Plan, self._json("POST", "/plans", json=body))

    def get_plan(self, plan_id: str) -> Plan:
        """A stored plan."""
        return parse(Plan, self._json("GET", f"/plans/{quoted(plan_id)}"))

    def export_plan(self, plan_id: str, file_format: str, rate: float | None = None) -> bytes:
        """A stored plan as a file; `rate` is that of the joint commands in mcap [Hz]."""
        return self._export("plans", plan_id, file_format, rate)

    # ------------------------------------------------------------------ rollouts

    def rollout(
        self,
        terrain: str | Terrain | Mapping[str, Any] | None = None,
        *,
        progress: Progress | None = None,
        timeout: float = 900.0,
        **question: Any,
    ) -> Rollout:
        """Simulate and wait; `question` as in `submit`.

        Raises:
            ServiceError: If the job fails or is cancelled.
            TimeoutError: If it takes longer than `timeout` [s]; the job is cancelled then.
        """
        job = self.submit(terrain, **question)
        return self.result(self.wait(job.id, progress=progress, timeout=timeout))

    def submit(
        self,
        terrain: str | Terrain | Mapping[str, Any] | None = None,
        robot: str | Robot | Mapping[str, Any] = "a1_wheeled",
        friction: float | None = None,
        method: Method = "path",
        weights: Mapping[str, float] | None = None,
        *,
        plan_id: str | None = None,
        controller: Mapping[str, Any] | None = None,
        seed: int = 0,
    ) -> JobState:
        """Start a rollout of a stored plan or of one to be made. A lost answer starts no second."""
        body: dict[str, Any] = {"controller": dict(controller or {}), "seed": seed}
        if terrain is not None:
            body |= _question(terrain, robot, friction, method, weights)
        else:
            body |= {"plan_id": plan_id}
            if friction is not None:
                body["friction"] = friction
        return self._start("/rollouts", body)

    def trials(
        self,
        plan_id: str,
        count: int = 29,
        bundle: str | None = None,
        *,
        progress: Progress | None = None,
        timeout: float = 3600.0,
        **question: Any,
    ) -> Trials:
        """Roll a stored plan out many times under random deviations, and wait.

        `question` may hold friction, controller, seed, and `ranges` instead of a bundle.

        Raises:
            ServiceError: If the job fails or is cancelled.
            TimeoutError: If it takes longer than `timeout` [s]; the job is cancelled then.
        """
        from stairwright.simulation.trials_result import Trials

        body = {"plan_id": plan_id, "count": count, "bundle": bundle, **question}
        job = self.wait(self._start("/trials", body).id, progress=progress, timeout=timeout)
        return parse(Trials, self._json("GET", f"/trials/{_result_of(job)}"))

    def margins(
        self,
        plan_id: str,
        *,
        progress: Progress | None = None,
        timeout: float = 900.0,
        **question: Any,
    ) -> RobustMargins:
        """Find how much delay, and how much less friction, a stored plan stands, and wait.

        `question` may hold controller and seed.

        Raises:
            ServiceError: If the job fails or is cancelled.
            TimeoutError: If it takes longer than `timeout` [s]; the job is cancelled then.
        """
        from stairwright.simulation.margins_result import RobustMargins

        body = {"plan_id": plan_id, **question}
        job = self.wait(self._start("/margins", body).id, progress=progress, timeout=timeout)
        return parse(RobustMargins, self._json("GET", f"/margins/{_result_of(job)}"))

    def result(self, job: JobState) -> Rollout:
        """What a job that is done led to.

        Raises:
            ServiceError: If it failed or was cancelled.
        """
        return self.get_rollout(_result_of(job))

    def get_rollout(self, rollout_id: str) -> Rollout:
        """A stored rollout."""
        from stairwright.simulation.result import Rollout

        return parse(Rollout, self._json("GET", f"/rollouts/{quoted(rollout_id)}"))

    def export_rollout(self, rollout_id: str, file_format: str) -> bytes:
        """A stored rollout as a file."""
        return self._export("rollouts", rollout_id, file_format)


def _question(
    terrain: str | Terrain | Mapping[str, Any],
    robot: str | Robot | Mapping[str, Any],
    friction: float | None,
    method: Method,
    weights: Mapping[str, float] | None,
) -> dict[str, Any]:
    body = {"terrain": _plain(terrain), "robot": _plain(robot), "method": method}
    if friction is not None:
        body["friction"] = friction
    return {**body, "weights": dict(weights or {})}


def _result_of(job: JobState) -> str:
    if job.result is None:
        raise ServiceError(job.error or {"detail": f"the job is {job.state}"})
    return job.result.rsplit("/", 1)[-1]


def _plain(source: str | Model | Mapping[str, Any]) -> Any:
    if isinstance(source, Model):
        return source.model_dump(mode="json")
    return source if isinstance(source, str) else dict(source)


def _saved(model: type[M], data: Mapping[str, Any]) -> M:
    """A document without what GET adds to it."""
    return parse(model, {k: value for k, value in data.items() if k not in ("readonly", "version")})
