"""What a robot does that waits for another plan, because it found other than its plan believes."""

from __future__ import annotations

import math

import numpy as np

from stairwright import _core
from stairwright.arrays import Floats
from stairwright.control.setpoint import PITCH, PROGRESS, TRUNK, WHEELS
from stairwright.control.settings import ControllerSettings
from stairwright.planning.plan import Plan
from stairwright.planning.standing import StandingPose
from stairwright.terrain.profile import Terrain
from stairwright.terrain.wheel_path import WheelPath, wheel_path

from .governor import Track, follower, lead_of, plan_track
from .map_correction import corrected, nearest_row
from .replanning import (
    after_slip,
    after_weighing,
    needed_friction,
    plan_anew,
    plan_onward,
    tested_friction,
)

_FARTHER = 0.05  # m that a robot must have come before it goes on after another stop


class PlanChange:
    """Decides how the native loop goes on where it waits.

    Attributes:
        followed: The plan that is followed now.
        track: Its lines.
    """

    def __init__(
        self,
        loop: _core.Rollout,
        plan: Plan,
        path: WheelPath,
        track: Track,
        settings: ControllerSettings,
    ) -> None:
        self.followed, self.track = plan, track
        self._loop, self._plan, self._settings = loop, plan, settings
        self._known, self._path = plan.terrain, path  # as the robot has found it
        self._went_on = -math.inf  # progress at which it did so after a stop [m]
        self._tolerate(plan)

    def decide(self) -> str:
        """Go on, with another plan or the old one; why the robot must stop, or nothing."""
        loop = self._loop
        if not loop.waits:
            return ""
        if loop.map_error is not None:
            self._mend_map(*loop.map_error)
        elif loop.slipped is not None:
            return self._after_slip(*loop.slipped)
        elif loop.load is not None:
            return self._after_weighing(*loop.load)
        return ""

    def goes_on_from_here(self) -> bool:
        """Whether a robot that has stopped has a plan from where it stands, which it follows now.

        It is not to stop for ever at the same place.
        """
        target = np.array(self._loop.target)
        if not self._loop.may_go_on or target[PROGRESS] < self._went_on + _FARTHER:
            return False
        plan = self._onward(self._known, target)
        if plan is None:
            return False
        self._went_on = float(target[PROGRESS])
        self._follow(plan)
        return True

    def _after_weighing(self, mass: float, place: _core.Vec2, shift: _core.Vec2) -> str:
        """Go on with a plan for the robot as it was found to be, or the old one if it stands it."""
        decision = after_weighing(self._plan, mass, (place.x, place.z), (shift.x, shift.z))
        if decision.plan is None:
            self._loop.go_on()
        else:
            self._plan = plan = decision.plan
            track = plan_track(plan, self._path, self._settings)
            self._loop.carry(plan.robot_description.native, tested_friction(track, plan))
            self._follow(plan, track)
        return decision.why

    def _after_slip(self, found: float, front: bool) -> str:
        need = needed_friction(self.track, self._plan)
        decision = after_slip(self._plan, need, found, front=front)
        if decision.plan is None:
            self._loop.go_on()
        else:
            self._follow(decision.plan)
        return decision.why

    def _mend_map(self, face: bool, s: float, along: float, up: float, pairs: int) -> None:
        """Go on with a plan on the map as it was found, or with the old one if there is none.

        Wheels that a riser stopped before they were there by the old one cannot: the robot stops.
        """
        loop = self._loop
        off = np.array([along, 0.0] if face else [0.0, up])
        front, rear = np.reshape(loop.places, (2, 2)).mean(axis=1)
        centres = self._path.centres(np.array([front, rear]))
        centres[:pairs] -= off
        known = corrected(self._known, self._path, s, face=face, off=off)
        path = wheel_path(known, self.followed.robot_description.wheel.radius)
        target = np.array(loop.target)
        target[WHEELS] = [path.project(centre) for centre in centres]
        target[TRUNK] -= 0.5 * pairs * off
        found = self._on_the_map(known, path, target)
        if found is None:
            if face and pairs == 0:
                loop.give_up()
            else:
                loop.go_on()
            return
        self._known, self._path = known, path
        loop.correct_map(path.native)
        plan, track, row = found
        self._follow(plan, track, row)

    def _on_the_map(
        self, known: Terrain, path: WheelPath, target: Floats
    ) -> tuple[Plan, Track, int] | None:
        """A plan over the map `known`, its track, and the row from which that is to be followed.

        A plan from here, unless a row of that from the start is as near as makes no difference.
        """
        found = None
        plan = plan_anew(self.followed, known, self.followed.friction)
        if plan is not None:
            track = plan_track(plan, path, self._settings)
            row = nearest_row(track, target)
            if row is not None:
                found = plan, track, row.number
                if row.near:
                    return found
        onward = self._onward(known, target)
        return found if onward is None else (onward, plan_track(onward, path, self._settings), 0)

    def _onward(self, known: Terrain, target: Floats) -> Plan | None:
        front, rear = target[WHEELS].tolist()
        here = StandingPose((front, rear), np.array([*target[TRUNK], target[PITCH]]))
        return plan_onward(self.followed, known, here, float(target[PROGRESS]))

    def _follow(self, plan: Plan, track: Track | None = None, row: int = 0) -> None:
        """Follow another plan from now on, from one of the rows of its track."""
        self.followed = plan
        self.track = track or plan_track(plan, self._path, self._settings)
        line = follower(self.track, lead_of(plan, self._settings), row)
        self._loop.adopt(line, plan.least_friction)
        self._tolerate(plan)

    def _tolerate(self, plan: Plan) -> None:
        """Where the map is wrong by no more than the plan was made to stand, nobody is asked."""
        if plan.tolerance is not None:
            self._loop.tolerate(plan.tolerance.height, plan.tolerance.place)
        else:
            self._loop.tolerate(-1.0, -1.0)
