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
from stairwright.control.controller import Controller
from stairwright.control.native import native_controller
from stairwright.control.setpoint import PROGRESS, RATES, Setpoint
from stairwright.control.settings import ControllerSettings
from stairwright.documents import content_hash
from stairwright.planning.plan import Plan
from stairwright.planning.poses.interpolation import reference
from stairwright.planning.smoothing.path_timing import retimed
from stairwright.robot.description import LEGS
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import wheel_path

from . import score
from .crossing import speed_over_faces
from .disturbance import Disturbance
from .governor import Track, cruise, follower, track
from .outcome import Ending, LinkLoads, ProgressWatch, fallen, judge
from .record import Recorder
from .result import Metrics, Rollout
from .sensors import Sensors
from .world import build_world, course_frame, real_terrain

Floats = NDArray[np.float64]

_PIECE = re.compile(r"(?<=trunk|thigh|_calf)_\d+$")  # of a part that is several shapes
CONTROL_STEPS = 2  # physics steps per control step: 500 Hz
SETTLE = 0.4  # s at rest before the plan starts and after it ends
DRIFT = 0.01  # of the way: what wheels that roll without slip may be off by
FAST_LEAD = 4.0  # of the usual lead, for plans that are driven fast
STANDS = 1.0  # s that a robot which gave up must stand
STOPS = {  # why it gives up, see control/safe_stop.hpp
    1: "the wheels did not follow the plan for 3 s",
    2: "the trunk leant too far from the plan",
}
CHUNK = 125  # control steps between reports of progress
_HUGE = 1e6  # stands for what is not finite, or overflowed on the way there
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
        self.friction, self.disturbance = friction, disturbance
        self.robot = robot = plan.robot_description
        self.path = wheel_path(plan.terrain, robot.wheel.radius)
        self.terrain = terrain = real_terrain(plan.terrain, disturbance, seed)
        self.model, self.data = self._world(terrain)
        self.dt = CONTROL_STEPS * self.model.opt.timestep
        self.track: Track = self._track()
        self.limit = 2.5 * self.track.duration + 5.0
        self.sensors = Sensors(disturbance, self.dt, seed, plan.poses[0].x_c)
        self.way = self.track.start
        self.follower = follower(self.track, self._lead)
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

    @property
    def _fast(self) -> bool:
        """Whether the plan's times are those of a moving robot."""
        return self.plan.timing.rule == "fast"

    @property
    def _lead(self) -> float:
        """How far the plan may be ahead of the wheels [m]: they lag the more the faster it is."""
        return self.settings.lead * (FAST_LEAD if self._fast else 1.0)

    def _track(self) -> Track:
        plan, settings = self.plan, self.settings
        steady = plan.method == "path" and settings.form == "contact" and not self._fast
        if steady and settings.speed is not None:
            # Another speed keeps what slows a plan down where margins are thin.
            plan = retimed(plan, settings.speed)
            settings = settings.model_copy(update={"speed": None})
        course = reference(plan, joint_rate=None)
        return track(course, self.robot, self.path, plan.friction, settings, fast=self._fast)

    def _native(self, every: int) -> _core.Rollout:
        controller = native_controller(self.robot, self.path, self.plan.friction, self.settings)
        model, data = int(self.model._address), int(self.data._address)  # noqa: SLF001
        line = follower(self.track, self._lead)
        bandwidth = self.disturbance.bandwidth
        perception = self._perception()
        scale = 1.0 + self.disturbance.torque_scale
        return _core.Rollout(
            model, data, controller, line, perception, bandwidth, scale, every, CONTROL_STEPS
        )

    def _perception(self) -> _core.IdealSense | _core.RobotSense:
        """What the controller gets to know."""
        deviation, start = self.disturbance, self.plan.poses[0]
        late = len(self.sensors.history) - 1
        if self.settings.sensing == "ideal":
            return _core.IdealSense(
                late, start.x_c, deviation.x_offset, deviation.odometry_scale, deviation.pitch_bias
            )
        return _core.RobotSense(
            self.robot.native,
            self.path.native,
            start=(start.x_c, start.z_c),
            pitch=start.pitch,
            errors=self._sensor_errors(),
            delay_steps=late,
            seed=self.seed,
        )

    def _sensor_errors(self) -> _core.SensorErrors:
        deviation, imu = self.disturbance, self.disturbance.imu
        errors = _core.SensorErrors(max(1.0, deviation.noise))  # real sensors have it anyway
        errors.wheel_scale, errors.tilt = deviation.odometry_scale, deviation.pitch_bias
        errors.gyro_offset, errors.force_offset = [imu.gyro_bias] * 3, [imu.accelerometer_bias] * 3
        if imu.gyro_noise is not None:
            errors.gyro = imu.gyro_noise
        if imu.accelerometer_noise is not None:
            errors.specific_force = imu.accelerometer_noise
        return errors

    def _place(self) -> None:
        """Put the robot into the plan's first pose."""
        pose = self.plan.poses[0]
        front, rear = list(pose.q[:2]), list(pose.q[2:])
        qpos = self.data.qpos
        qpos[:3] = pose.x_c - self.disturbance.x_offset, 0.0, pose.z_c
        qpos[3:7] = math.cos(pose.pitch / 2), 0.0, math.sin(pose.pitch / 2), 0.0
        qpos[7:] = [*front, 0.0, *front, 0.0, *rear, 0.0, *rear, 0.0]
        mujoco.mj_forward(self.model, self.data)
        # A terrain other than planned may reach above or below the wheels: stand on it.
        lift = max((-float(d) for d in self.data.contact.dist), default=0.0)
        if lift > 1e-3:
            qpos[2] += lift
            mujoco.mj_forward(self.model, self.data)

    def simulate(
        self,
        progress: Callable[[float], None] | None,
        observe: Callable[[Recorder], None] | None = None,
    ) -> Ending:
        """Run the loop to its end."""
        watch, begin = ProgressWatch(), time.perf_counter()
        steps, settled = 0, 0
        total = self.track.end - self.track.start
        while True:
            cause = self._chunk(steps * self.dt >= SETTLE)
            steps += CHUNK
            now = self.time = steps * self.dt
            done = (self.way - self.track.start) / total
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
            elif not self._stopping() and watch.stuck(now, self.way):
                cause = ("stuck", "")
                break
            why = self._gave_up(now)
            if why:
                cause = ("stopped", why)
                break
            if now > self.limit:
                cause = ("timeout", "")
                break
        self.wall = time.perf_counter() - begin
        first, last = self.track.rows[[0, -1], PROGRESS]
        reached = (float(self.target[PROGRESS] - first), float(last - first))
        return Ending(cause[0], self.time, reached, self._end_error(), cause[1])

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

    def _native_steps(self, native: _core.Rollout, moving: bool) -> None:
        noise, at, looked = self.sensors.draws(CHUNK), 0, False
        while at < CHUNK:
            loaded = bool(self.loads.loads)
            at = native.run(at, CHUNK, looked, loaded, moving, self.time, noise)
            if at < CHUNK:
                self._touch(self.time + at * self.dt)
                looked = True
        self.way, self.target[:] = native.way, native.target
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
        self.way = self.follower.way
        if self.settings.form == "paper" and moving and self.way < t.end - 1e-9:
            # Eq 15 follows a speed and no place: held back by the lead it would never catch up.
            self.target[RATES : RATES + 2] = cruise(t, self.way)
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

    def _end_error(self) -> float:
        """Largest distance of a wheel from where the plan ends on the real terrain [m].

        Judged along the path: what a deviation makes of the way itself (a start elsewhere, faces
        moved, a wrong measure of length), and where the robot senses by itself the drift of its
        wheels since the last face, is not held against it. It can know where it is on the stairs,
        not in the world. Across the path what counts is the ground that is there.
        """
        deviation = self.disturbance
        turn, origin = course_frame(deviation, self.plan.poses[0].x_c)
        wheels = self._wheels()
        x, _, z = (turn.T @ (wheels - origin).T) + origin[:, None]
        if not np.isfinite([x, z]).all():
            return math.inf
        end = np.array(self.plan.poses[-1].wheels)[[0, 0, 1, 1]]
        start = np.array(self.plan.poses[0].wheels)[[0, 0, 1, 1]]
        way = np.abs(end[:, 0] - start[:, 0])
        lost = abs(deviation.x_offset) + self._faces_moved()
        lost = lost + (abs(deviation.odometry_scale) + 1.0 - math.cos(deviation.heading)) * way
        if self.settings.sensing == "robot":
            lost = lost + DRIFT * self._since_last_face(end[:, 0])
        off = np.maximum(0.0, np.abs(x - end[:, 0]) - lost)
        real = wheel_path(self.terrain, self.robot.wheel.radius)
        places = np.column_stack([x, z])
        nearest = real.centres(np.array([real.project(place) for place in places]))
        off_ground = np.hypot(*(places - nearest).T)
        return float(np.hypot(off, off_ground).max())

    def _faces_moved(self) -> float:
        """How far a face is from where it was drawn, at most [m]."""
        real, drawn = (np.array(t.points)[:, 0] for t in (self.terrain, self.plan.terrain))
        return float(np.abs(real - drawn).max())

    def _since_last_face(self, x: Floats) -> Floats:
        """Way from the last steep face before each `x` (n,), or from the start (n,) [m]."""
        vertices, start = self.plan.terrain.vertices, self.plan.poses[0].x_c
        dx, dz = np.diff(vertices, axis=0).T
        faces = np.append(vertices[1:, 0][np.abs(dz) > dx], start)
        return np.array([float((at - faces[faces <= at]).min(initial=at - start)) for at in x])

    def _at_rest(self) -> bool:
        return bool(np.abs(self.data.qvel[:3]).max() < 0.02)

    def result(self, ending: Ending, keep_plan: bool) -> Rollout:
        """The document of what happened."""
        plan, robot = self.plan, self.robot
        outcome, reason = judge(ending, self.loads, robot.mass * 9.81)
        series = self.recorder.series()
        # A diverged run still has a document.
        s = np.nan_to_num(self.score, posinf=_HUGE, neginf=-_HUGE)
        steps = max(1.0, s[score.STEPS])
        reached, total = ending.progress
        metrics = Metrics(
            duration=ending.time,
            pitch_error_max=s[score.PITCH_MAX],
            pitch_error_rms=math.sqrt(s[score.PITCH_SQUARES] / steps),
            joint_error_rms=math.sqrt(s[score.JOINT_SQUARES] / steps / 8),
            torque_peak=s[score.LEG_TORQUE],
            wheel_torque_peak=s[score.WHEEL_TORQUE],
            energy=s[score.ENERGY],
            link_contacts=self.loads.contacts,
            link_force_peak=min(self.loads.peak, _HUGE),
            self_contacts=self.loads.self_contacts,
            end_error=min(ending.error, _HUGE),
            progress=reached / total,
            speed_mean=reached / max(ending.time - SETTLE, self.dt),
            speed_stairs=speed_over_faces(series, self.terrain, robot),
            cost_of_transport=s[score.ENERGY] / (robot.mass * 9.81 * reached)
            if reached > 0.0
            else None,
            real_time_factor=ending.time / max(self.wall, 1e-9),
        )
        deviations = self.disturbance.model_dump(mode="json", exclude_defaults=True)
        key = [plan.id, plan.friction, self.friction, self.seed, self.settings.model_dump()]
        if self.simulated:
            key.append(self.simulated)
        return Rollout(
            id="r-" + content_hash([*key, deviations]).removeprefix("sha256:"),
            plan_id=plan.id,
            method=plan.method,
            terrain=plan.terrain,
            terrain_hash=plan.terrain_hash,
            robot=plan.robot,
            robot_hash=plan.robot_hash,
            robot_description=robot,
            model=self.simulated,
            friction=self.friction,
            seed=self.seed,
            controller=self.settings,
            disturbance=deviations,
            outcome=outcome,
            reason=reason,
            metrics=metrics,
            series=series,
            plan=plan if keep_plan else None,
        )
