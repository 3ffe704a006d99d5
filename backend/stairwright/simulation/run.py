"""One rollout: model, controller and score from the first step to the ending."""

from __future__ import annotations

import math
import re
import time
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from stairwright import _core
from stairwright._core import GRAVITY
from stairwright.control.controller import Controller
from stairwright.control.native import native_controller
from stairwright.control.setpoint import PROGRESS, RATES, Setpoint
from stairwright.control.settings import ControllerSettings
from stairwright.documents import content_hash
from stairwright.planning.plan import Plan
from stairwright.robot.description import LEGS
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import wheel_path

from . import score
from .crossing import speed_over_faces
from .disturbance import Disturbance
from .end_error import end_error
from .governor import Track, cruise, follower, lead_of, plan_track
from .map_correction import corrected, nearest_row
from .measured import SETTLE, measured
from .outcome import Ending, LinkLoads, ProgressWatch, fallen, judge
from .perception import perception
from .record import Recorder
from .replanning import after_slip, needed_friction, plan_anew, tested_friction
from .result import Rollout
from .sensors import Sensors
from .world import build_world, real_terrain

Floats = NDArray[np.float64]

_PIECE = re.compile(r"(?<=trunk|thigh|_calf)_\d+$")  # of a part that is several shapes
CONTROL_STEPS = 2  # physics steps per control step: 500 Hz
STANDS = 1.0  # s that a robot which gave up must stand
STOPS = {  # why it gives up, see control/safe_stop.hpp
    1: "the wheels did not follow the plan for 3 s",
    2: "the trunk leant too far from the plan",
}
SAME_GROUND = 1e-3  # m between wheels that are on one face or tread
CHUNK = 125  # control steps between reports of progress
_DIVERGED = (
    mujoco.mjtWarning.mjWARN_BADQPOS,
    mujoco.mjtWarning.mjWARN_BADQVEL,
    mujoco.mjtWarning.mjWARN_BADQACC,
)


def runs_natively(settings: ControllerSettings) -> bool:
    """Whether these settings run in the native loop."""
    return settings.form == "contact" and settings.solver == "native"


class Run:
    """One rollout: model, memory of the controller, score and record."""

    simulated = ""  # the file whose model this is, if it is not ours
    own_model = True  # ours, whose state the native loop reads where it lies

    def __init__(
        self,
        plan: Plan,
        friction: float,
        settings: ControllerSettings,
        disturbance: Disturbance,
        seed: int,
        record_hz: float,
    ) -> None:
        self.plan, self.settings, self.seed = plan, settings, seed
        self.followed = plan  # another one where the plan was changed on the way
        self.friction, self.disturbance = friction, disturbance
        self.robot = robot = plan.robot_description
        self.path = wheel_path(plan.terrain, robot.wheel.radius)
        self.known = plan.terrain  # as the robot has found it
        self.terrain = terrain = real_terrain(plan.terrain, disturbance, seed)
        self.model, self.data = self._world(terrain)
        self.dt = CONTROL_STEPS * self.model.opt.timestep
        self.track: Track = plan_track(plan, self.path, settings)
        self.limit = 2.5 * self.track.duration + 5.0
        self.sensors = Sensors(disturbance, self.dt, seed, plan.poses[0].x_c)
        self.position = self.track.start
        self.follower = follower(self.track, lead_of(plan, settings))
        self.places = np.full(4, np.nan)
        self.target = np.zeros(self.track.rows.shape[1])
        self.wanted = np.zeros(12)
        self.score = np.zeros(score.SCORES)
        self.loads = LinkLoads(self.dt)
        self.names = self._geom_names()
        self.floor = float(terrain.vertices[:, 1].min())
        every = max(1, round(1.0 / (record_hz * self.dt)))
        self.controller: Controller | None = None
        self.native: _core.Rollout | None = None
        if self.own_model and runs_natively(settings):
            self.native = self._native(every)
        else:
            self.controller = Controller(robot, self.path, plan.friction, settings)
        self.recorder = Recorder(every, self.track, robot.wheel.radius, self.native)
        self.wall = self.time = 0.0
        self._place()

    def _world(self, terrain: Terrain) -> tuple[Any, Any]:
        """The model to simulate and its state."""
        begin = self.plan.poses[0].x_c
        model = build_world(self.robot, terrain, self.friction, self.disturbance, begin)
        return model, mujoco.MjData(model)

    def _geom_names(self) -> list[str]:
        """What each shape is part of."""
        names = [self.model.geom(i).name for i in range(self.model.ngeom)]
        return [_PIECE.sub("", name) for name in names]

    def _native(self, every: int) -> _core.Rollout:
        controller = native_controller(self.robot, self.path, self.plan.friction, self.settings)
        model, data = int(self.model._address), int(self.data._address)  # noqa: SLF001
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
            model, data, controller, line, perceived, bandwidth, scale, every, CONTROL_STEPS,
            grip_need=need, mends_map=self.plan.timing.rule != "fast",
        )  # fmt: skip

    def _place(self) -> None:
        """Put the robot into the plan's first pose."""
        qpos = self.data.qpos
        qpos[:] = self._first_positions()
        qpos[0] -= self.disturbance.x_offset
        mujoco.mj_forward(self.model, self.data)
        # A terrain other than planned may reach above or below the wheels: stand on it.
        lift = max((-float(d) for d in self.data.contact.dist), default=0.0)
        if lift > 1e-3:
            qpos[2] += lift
            mujoco.mj_forward(self.model, self.data)

    def _first_positions(self) -> Floats:
        """Place, quaternion and joints (19,) of the plan's first pose."""
        pose = self.plan.poses[0]
        front, rear = (*pose.q[:2], 0.0), (*pose.q[2:], 0.0)
        turn = math.cos(pose.pitch / 2), 0.0, math.sin(pose.pitch / 2), 0.0
        return np.array([pose.x_c, 0.0, pose.z_c, *turn, *front, *front, *rear, *rear])

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
            done = (self.position - self.track.start) / (self.track.end - self.track.start)
            if progress is not None:
                progress(min(1.0, 0.999 * done))
            if observe is not None:
                observe(self.recorder)
            if cause:
                break
            if done >= 1.0 - 1e-9:
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
        first, last = self.track.rows[[0, -1], PROGRESS]
        reached = (float(self.target[PROGRESS] - first), float(last - first))
        own = self.settings.sensing == "robot"
        error = end_error(
            self.followed,
            self.plan.terrain,
            self.terrain,
            self.disturbance,
            self._wheels(),
            own_sensors=own,
        )
        return Ending(cause[0], self.time, reached, error, cause[1])

    def _chunk(self, moving: bool) -> tuple[str, str] | None:
        """Some control steps; the cause and its words if the rollout is over."""
        data = self.data
        if self.native is not None:
            self._native_steps(self.native, moving)
        else:
            self._plain_steps(moving)
        # MuJoCo starts anew, with a warning, when it finds numbers that are not finite.
        warned = any(data.warning[kind].number for kind in _DIVERGED)
        if warned or score.diverged(data.qpos, data.qvel):
            return "diverged", ""
        pitch_error, tilt = self.score[score.LAST_PITCH_ERROR], self.score[score.TILT]
        why = fallen(pitch_error, tilt, data.qpos[2], self.floor)
        return ("fell", why) if why else None

    def _stopping(self) -> bool:
        return self.native is not None and self.native.stop != 0

    def _gave_up(self, now: float) -> str:
        """Why the robot has stopped by itself, once it stands; empty before."""
        if self.native is None or self.native.stop == 0 or now - self.native.stopped_at < STANDS:
            return ""
        return STOPS[self.native.stop] if self._at_rest() else ""

    def _decide(self, watch: ProgressWatch) -> str:
        """Go on with another plan where the robot waits for one; why it must stop, or nothing."""
        native = self.native
        if native is None or not native.waits:
            return ""
        if native.map_error is not None:
            self._mend_map(native, native.map_error, watch)
            return ""
        if native.slipped is None:
            return ""
        found, front = native.slipped
        need = needed_friction(self.track, self.plan)
        decision = after_slip(self.plan, need, found, front=front)
        if decision.plan is not None:
            self._follow(decision.plan, watch)
        else:
            native.go_on()
        return decision.why

    def _mend_map(
        self,
        native: _core.Rollout,
        found: tuple[bool, float, float, float],
        watch: ProgressWatch,
    ) -> None:
        """Go on with a plan on the map as it was found, or with the old one if there is none."""
        face, s, *by = found
        off = np.array(by) * ([1.0, 0.0] if face else [0.0, 1.0])
        front, rear = np.reshape(native.places, (2, 2)).mean(axis=1)
        centres = self.path.centres(np.array([front, rear]))
        across = 0 if face else 1
        both = abs(np.diff(centres[:, across])[0]) < SAME_GROUND
        centres -= [off, off if both else np.zeros(2)]
        known = corrected(self.known, self.path, s, face=face, off=off)
        plan = plan_anew(self.followed, known, self.followed.friction)
        if plan is None:
            native.go_on()
            return
        path = wheel_path(known, self.robot.wheel.radius)
        places = np.array([path.project(centre) for centre in centres])
        line = plan_track(plan, path, self.settings)
        row = nearest_row(line, places, np.asarray(native.target))
        if row is None:
            native.go_on()
            return
        self.known, self.path = known, path
        native.correct_map(path.native)
        self._follow(plan, watch, row)

    def _follow(self, plan: Plan, watch: ProgressWatch, row: int = 0) -> None:
        """Follow another plan from now on, from one of its rows."""
        assert self.native is not None
        self.followed = plan
        self.track = plan_track(plan, self.path, self.settings)
        line = follower(self.track, lead_of(plan, self.settings), row)
        self.native.adopt(line, plan.friction)
        self.limit = self.time + 2.5 * self.track.duration + 5.0
        watch.best, watch.since = -math.inf, self.time

    def _native_steps(self, native: _core.Rollout, moving: bool) -> None:
        noise, at, looked = self.sensors.draws(CHUNK), 0, False
        while at < CHUNK:
            loaded = bool(self.loads.loads)
            at = native.run(at, CHUNK, looked, loaded, moving, self.time, noise)
            if at < CHUNK:
                self._touch(self.time + at * self.dt)
                looked = True
        self.position, self.target[:] = native.position, native.target
        self.score[:] = score.numbers(native.score)

    def _plain_steps(self, moving: bool) -> None:
        assert self.controller is not None
        data = self.data
        for k in range(CHUNK):
            if score.diverged(data.qpos, data.qvel):
                break
            wheels = self._tick(moving, *self.sensors.sense(data.qpos, data.qvel))
            self.recorder.take(data, self.target, self.places)
            if data.sensordata[16] != wheels or self.loads.loads:
                self._touch(self.time + k * self.dt)
            self._advance()

    def _advance(self) -> None:
        """Physics until the next control step."""
        mujoco.mj_step(self.model, self.data, CONTROL_STEPS)

    def _tick(self, moving: bool, qpos: Floats, qvel: Floats) -> int:
        """One control step with the numpy controller; how many contacts the wheels have."""
        assert self.controller is not None
        t = self.track
        self.target[:] = self.follower.advance(self.places, moving, self.dt)
        self.position = self.follower.position
        if self.settings.form == "paper" and moving and self.position < t.end - 1e-9:
            # Eq 15 follows a speed and no place: held back by the lead it would never catch up.
            self.target[RATES : RATES + 2] = cruise(t, self.position)
        self.wanted[:] = self.controller.step(qpos, qvel, Setpoint.from_row(self.target))
        self.places[:] = self.controller.places
        data = self.data
        data.ctrl[:] = _core.limit_torques(self.robot.native, data.qvel[6:], self.wanted)
        score.keep_score(data.qpos, data.qvel, data.ctrl, self.target, self.dt, self.score)
        return int(data.sensordata[0:16:4].sum())

    def _touch(self, time: float) -> None:
        """Book contacts that are not a wheel on the terrain."""
        force, own = np.zeros(6), False
        loads: dict[str, float] = {}
        for i, (a, b) in enumerate(self.data.contact.geom[: self.data.ncon]):
            first, second = self.names[a], self.names[b]
            if second.startswith("terrain"):
                first, second = second, first
            if not first.startswith("terrain"):
                own = True
            elif not second.endswith("wheel"):
                self._contact_force(i, force)
                loads[second] = loads.get(second, 0.0) + float(np.hypot(*force[:2]))
        self.loads.self_contacts += own
        self.loads.add(time, loads)

    def _contact_force(self, contact: int, force: Floats) -> None:
        """Write the force and torque (6,) of a contact, in its own frame, into `force`."""
        mujoco.mj_contactForce(self.model, self.data, contact, force)

    def _wheels(self) -> Floats:
        """Centres (4, 3) of the wheels in the world [m]."""
        return np.array([self.data.body(f"{leg}_wheel").xpos for leg in LEGS])

    def _at_rest(self) -> bool:
        return bool(np.abs(self.data.qvel[:3]).max() < 0.02)

    def result(self, ending: Ending, keep_plan: bool) -> Rollout:
        """The document of what happened."""
        outcome, reason = judge(ending, self.loads, self.robot.mass * GRAVITY)
        plan, series = self.plan, self.recorder.series()
        deviations = self.disturbance.model_dump(mode="json", exclude_defaults=True)
        key = [plan.id, plan.friction, self.friction, self.seed, self.settings.model_dump()]
        if self.simulated:
            key.append(self.simulated)
        speed = speed_over_faces(series, self.terrain, self.robot)
        return Rollout(
            id="r-" + content_hash([*key, deviations]).removeprefix("sha256:"),
            plan_id=plan.id,
            method=plan.method,
            terrain=plan.terrain,
            terrain_hash=plan.terrain_hash,
            robot=plan.robot,
            robot_hash=plan.robot_hash,
            robot_description=self.robot,
            model=self.simulated,
            friction=self.friction,
            seed=self.seed,
            controller=self.settings,
            disturbance=deviations,
            outcome=outcome,
            reason=reason,
            metrics=measured(
                ending, self.loads, self.score, self.robot.mass, self.wall, self.dt, speed
            ),
            series=series,
            plan=plan if keep_plan else None,
        )
