"""Plans anew when somebody moves a weight in the scene's own panel."""

from __future__ import annotations

import asyncio
import gzip
import logging
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import orjson

from stairwright.documents import parse
from stairwright.errors import StairwrightError
from stairwright.jobs.planning import Answer, Planning
from stairwright.jobs.questions import PlanQuestion
from stairwright.planning.plan import PlanTiming
from stairwright.robot.description import Robot
from stairwright.robot.turning import turned
from stairwright.terrain.profile import Terrain

from .problems import Problem

if TYPE_CHECKING:
    from stairwright.scene.session import SceneSession

logger = logging.getLogger(__name__)

Weights = Mapping[str, float]


class Replanning:
    """One solve in flight for each scene; of the wishes that come meanwhile, the newest counts."""

    def __init__(self, planning: Planning) -> None:
        self._planning = planning
        self._wishes: dict[str, Weights] = {}
        self._at_work: dict[str, asyncio.Task[None]] = {}

    def for_scene(self, find: Callable[[], SceneSession], name: str) -> Callable[[Weights], None]:
        """What the scene calls, from any thread, with the weights that are wanted."""
        loop = asyncio.get_running_loop()

        def wish(weights: Weights) -> None:
            loop.call_soon_threadsafe(self._note, find, name, weights)

        return wish

    def _note(self, find: Callable[[], SceneSession], name: str, weights: Weights) -> None:
        self._wishes[name] = weights
        if name not in self._at_work:
            task = asyncio.create_task(self._follow(find, name))
            self._at_work[name] = task
            task.add_done_callback(lambda _: self._at_work.pop(name, None))

    async def _follow(self, find: Callable[[], SceneSession], name: str) -> None:
        while name in self._wishes:
            weights = self._wishes.pop(name)
            try:
                scene = find()
                if scene.plan is None:
                    return
                question = _question(scene.plan, weights)
                answer = await asyncio.to_thread(self._planning.stored, question)
                if answer is None:
                    answer = await self._planning.solve(question, name)
                await asyncio.to_thread(scene.show, await asyncio.to_thread(_document, answer))
            except Problem:
                return  # the scene was closed meanwhile
            except StairwrightError as error:
                logger.info("the scene was not planned anew: %s", error)
            except Exception:
                logger.exception("the scene was not planned anew")


def _question(plan: Mapping[str, Any], weights: Weights) -> PlanQuestion:
    terrain = parse(Terrain, plan["terrain"])
    robot, facing = parse(Robot, plan["robot_description"]), plan.get("facing", "forward")
    if facing == "backward":
        robot = turned(robot)
    timing: PlanTiming = "fast" if plan["timing"]["rule"] == "fast" else "steady"
    chosen = {**plan["weights"], **weights}
    asked = (plan["friction"], plan["method"], chosen, timing, plan.get("tolerance"), facing)
    return PlanQuestion.of(terrain, robot, *asked)


def _document(answer: Answer) -> Mapping[str, Any]:
    content = gzip.decompress(answer.content) if answer.cached else answer.content
    document: dict[str, Any] = orjson.loads(content)
    return document
