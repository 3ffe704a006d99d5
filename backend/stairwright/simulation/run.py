"""One rollout: model, controller and score from the first step to the ending."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from stairwright import _core
from stairwright._core import GRAVITY
from stairwright.arrays import Floats
from stairwright.control.controller import Controller
from stairwright.control.native import native_controller
from stairwright.control.setpoint import PROGRESS, RATES, Setpoint
from stairwright.control.settings import ControllerSettings
from stairwright.documents import content_hash
from stairwright.planning.plan import Plan
from stairwright.robot.kinematics import all_joints
from stairwright.terrain.wheel_path import wheel_path

from . import score
from .crossing import speed_over_faces
from .disturbance import Disturbance
from .end_error import end_error
from .governor import Track, cruise, follower, lead_of, plan_track
from .measured import SETTLE, measured
from .outcome import Ending, LinkLoads, ProgressWatch, fallen, judge
from .perception import perception
from .physics import CONTROL_STEPS, OwnPhysics, Physics
from .plan_change import PlanChange
from .record import Recorder
from .replanning import tested_friction
from .result import Rollout
from .sensors import Sensors

STANDS = 1.0  # s that a robot which gave up must stand
CHUNK = 125  # control steps between reports of progress


def runs_natively(settings: ControllerSettings) -> bool:
    """Whether these settings run in the native loop."""
    return settings.form == "contact" and settings.solver == "native"


class Run:
    """One rollout: model, memory of the controller, score and record."""

    def __init__(
        self,
        plan: Plan,
        friction: float,
        settings: ControllerSettings,
        disturbance: Disturbance,
        seed: int,
        record_hz: float,
        physics: Physics | None = None,
    ) -> None:
        self.plan, self.settings, self.seed = plan, settings, seed
        self.friction, self.disturbance = friction, disturbance
        self.robot = robot = plan.robot_description
        self.path = wheel_path(plan.terrain, robot.wheel.radius)
        self.physics = physics or OwnPhysics(plan, friction, disturbance, seed)
        self.data = self.physics.state
        self.dt = CONTROL_STEPS * self.physics.timestep
        self.track: Track = plan_track(plan, self.path, settings)
        self.limit = 2.5 * self.track.duration + 5.0
        self.sensors = Sensors(disturbance, self.dt, seed, plan.poses[0].x_c)
        self.position = self.track.start
        self.first = float(self.track.rows[0, PROGRESS])
        self.follower = follower(self.track, lead_of(plan, settings))
        self.places = np.full(4, np.nan)
        self.target = np.zeros(self.track.rows.shape[1])
        self.wanted = np.zeros(12)
        self.score = np.zeros(score.SCORES)
        self.loads = LinkLoads(self.dt)
        self.floor = float(self.physics.terrain.vertices[:, 1].min())
        every = max(1, round(1.0 / (record_hz * self.dt)))
        self.native: _core.Rollout | None = None
        self.change: PlanChange | None = None
        if isinstance(self.physics, OwnPhysics) and runs_natively(settings):
            self.native = self._native(self.physics.model, every)
            self.change = PlanChange(self.native, plan, self.path, self.track, settings)
        else:
            self.controller = Controller(robot, self.path, plan.least_friction, settings)
        self.recorder = Recorder(every, self.track, robot.wheel.radius, self.native)
        self.wall = self.time = 0.0
        self.physics.place(self._first_positions())

    def _native(self, model: Any, every: int) -> _core.Rollout:
        friction = self.plan.least_friction
        controller = native_controller(self.robot, self.path, friction, self.settings)
        addresses = int(model._address), int(self.data._address)  # noqa: SLF001
        line = follower(self.track, lead_of(self.plan, self.settings))
        bandwidth = self.disturbance.bandwidth
        late = len(self.sensors.history) - 1
        perceived = perception(
            self.plan, self.path, self.settings, self.disturbance, late, self.seed
        )
        own = self.settings.sensing == "robot"
        need = tested_friction(self.track, self.plan) if own else 0.0
        scale = 1.0 + self.disturbance.torque_scale
        return _core.Rollout(
            *addresses, controller, line, perceived, bandwidth, scale, every, CONTROL_STEPS,
            grip_need=need, mends_map=self.plan.timing.rule != "fast",
        )  # fmt: skip

    def _first_positions(self) -> Floats:
        """Place, quaternion and joints (19,) of the plan's first pose."""
        pose, x = self.plan.poses[0], self.plan.poses[0].x_c - self.disturbance.x_offset
        turn = math.cos(pose.pitch / 2), 0.0, math.sin(pose.pitch / 2), 0.0
        return np.array([x, 0.0, pose.z_c, *turn, *all_joints(np.array(pose.q))])

    def simulate(
        self,
        progress: Callable[[float], None] | None,
        observe: Callable[[Recorder], None] | None = None,
    ) -> Ending:
        """Run the loop to its end."""
        watch, begin = ProgressWatch(), time.perf_counter()
        steps, settled = 0, 0
        while True:
            cause = self._chunk(steps * self.dt >= SETTLE)
            steps += CHUNK
            now = self.time = steps * self.dt
            done, total = self._along_the_plan()
            if progress is not None:
                progress(min(1.0, 0.999 * done / total))
            if observe is not None:
                observe(self.recorder)
            if cause:
                break
            if self.position >= self.track.end - 1e-9:
                settled += CHUNK
                if settled * self.dt > SETTLE and (self._at_rest() or settled * self.dt > 2.0):
                    cause = ("arrived", "")
                    break
            elif not self._stopping() and watch.stuck(now, self.position):
                cause = ("stuck", "")
                break
            why = self._gave_up(now) or self._decide(watch)
            if why:
                cause = ("stopped", why)
                break
            if now > self.limit:
                cause = ("timeout", "")
                break
        self.wall = time.perf_counter() - begin
        own = self.settings.sensing == "robot"
        plan = self.plan if self.change is None else self.change.followed
        drawn, real, wheels = self.plan.terrain, self.physics.terrain, self.physics.wheels()
        error = end_error(plan, drawn, real, self.disturbance, wheels, own_sensors=own)
        return Ending(cause[0], self.time, self._along_the_plan(), error, cause[1])

    def _along_the_plan(self) -> tuple[float, float]:
        """How far the robot is and has to go in all [m]; plans from underway go on counting."""
        reached, end = self.target[PROGRESS], self.track.rows[-1, PROGRESS]
        return float(reached - self.first), float(end - self.first)

    def _chunk(self, moving: bool) -> tuple[str, str] | None:
        """Some control steps; the cause and its words if the rollout is over."""
        data = self.data
        if self.native is not None:
            self._native_steps(self.native, moving)
        else:
            self._plain_steps(moving)
        if self.physics.broken() or score.diverged(data.qpos, data.qvel):
            return "diverged", ""
        pitch_error, tilt = self.score[score.LAST_PITCH_ERROR], self.score[score.TILT]
        why = fallen(pitch_error, tilt, data.qpos[2], self.floor)
        return ("fell", why) if why else None

    def _stopping(self) -> bool:
        return self.native is not None and self.native.stopped

    def _gave_up(self, now: float) -> str:
        """Why the robot has stopped by itself, once it stands and does not go on; empty before."""
        if self.native is None or not self.native.stopped or now - self.native.stopped_at < STANDS:
            return ""
        if not self._at_rest() or (self.change and self.change.goes_on_from_here()):
            return ""
        return self.native.stop_reason

    def _decide(self, watch: ProgressWatch) -> str:
        """Go on where the robot waits, maybe with another plan; why it must stop, or nothing."""
        if self.change is None:
            return ""
        why = self.change.decide()
        if self.change.track is not self.track:
            self.track = self.change.track
            self.limit = self.time + 2.5 * self.track.duration + 5.0
            watch.best, watch.since = -math.inf, self.time
        return why

    def _native_steps(self, native: _core.Rollout, moving: bool) -> None:
        noise, at, looked = self.sensors.draws(CHUNK), 0, False
        while at < CHUNK:
            loaded = bool(self.loads.loads)
            at = native.run(at, CHUNK, looked, loaded, moving, self.time, noise)
            if at < CHUNK:
                self.touch(self.time + at * self.dt)
                looked = True
        self.position, self.target[:] = native.position, native.target
        self.score[:] = score.numbers(native.score)

    def _plain_steps(self, moving: bool) -> None:
        data = self.data
        for k in range(CHUNK):
            if score.diverged(data.qpos, data.qvel):
                break
            self._tick(moving, *self.sensors.sense(data.qpos, data.qvel))
            self.recorder.take(data, self.target, self.places)
            self.touch(self.time + k * self.dt)
            self.physics.advance()

    def _tick(self, moving: bool, qpos: Floats, qvel: Floats) -> None:
        """One control step with the numpy controller."""
        t = self.track
        advances = moving and not self.controller.tips
        self.target[:] = self.follower.advance(self.places, advances, self.dt)
        self.position = self.follower.position
        if self.settings.form == "paper" and moving and self.position < t.end - 1e-9:
            # Eq 15 follows a speed and no place: held back by the lead it would never catch up.
            self.target[RATES : RATES + 2] = cruise(t, self.position)
        self.wanted[:] = self.controller.step(qpos, qvel, Setpoint.from_row(self.target))
        self.places[:] = self.controller.places
        data = self.data
        data.ctrl[:] = _core.limit_torques(self.robot.native, data.qvel[6:], self.wanted)
        score.keep_score(data.qpos, data.qvel, data.ctrl, self.target, self.dt, self.score)

    def touch(self, time: float) -> None:
        """Book contacts that are not a wheel on the terrain, at `time` [s]."""
        own, loads = self.physics.touches()
        self.loads.add(time, loads, own)

    def _at_rest(self) -> bool:
        return bool(np.abs(self.data.qvel[:3]).max() < 0.02)

    def result(self, ending: Ending, keep_plan: bool) -> Rollout:
        """The document of what happened."""
        outcome, reason = judge(ending, self.loads, self.robot.mass * GRAVITY)
        plan, series = self.plan, self.recorder.series()
        deviations = self.disturbance.model_dump(mode="json", exclude_defaults=True)
        key = [plan.id, plan.friction, self.friction, self.seed, self.settings.model_dump()]
        if self.physics.source:
            key.append(self.physics.source)
        speed = speed_over_faces(series, self.physics.terrain, self.robot)
        return Rollout(
            id="r-" + content_hash([*key, deviations]).removeprefix("sha256:"),
            plan_id=plan.id,
            method=plan.method,
            terrain=plan.terrain,
            terrain_hash=plan.terrain_hash,
            robot=plan.robot,
            robot_hash=plan.robot_hash,
            robot_description=self.robot,
            model=self.physics.source,
            friction=self.friction,
            seed=self.seed,
            controller=self.settings,
            disturbance=deviations,
            outcome=outcome,
            reason=reason,
            metrics=measured(
                ending, self.loads, self.score, self.robot, series, self.wall, self.dt, speed
            ),
            series=series,
            plan=plan if keep_plan else None,
        )
