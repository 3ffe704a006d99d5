"""The scene's own panel: moving a weight plans anew, and the newest wish counts."""

from __future__ import annotations

import asyncio
import time
from pathlib import Path

import pytest

from stairwright.api.services import Services
from stairwright.api.settings import Settings
from stairwright.planning.planner import plan

CURB = {"points": [[-1.0, 0], [0, 0], [0, 0.05], [1, 0.05]]}


@pytest.mark.slow
def test_moving_a_weight_plans_anew(tmp_path: Path) -> None:
    async def story() -> None:
        services = Services(Settings(data=tmp_path))
        await services.start()
        try:
            name = await services.sessions.open()
            scene = services.sessions.get(name)
            first = plan(CURB, method="critical").model_dump(mode="json")
            scene.show(first)
            replan = scene._panel._replan
            assert replan is not None
            for value in (3.0, 4.0, 5.0):
                replan({**first["weights"], "com_x": value})
            give_up = time.monotonic() + 100
            while scene.plan is None or scene.plan["weights"]["com_x"] != 5.0:
                assert time.monotonic() < give_up
                await asyncio.sleep(0.02)
            assert scene.plan["terrain"] == first["terrain"]
            assert len(services.store.documents.page("plan", 10, 0)[0]) <= 2  # 4.0 was passed over
        finally:
            await services.stop()

    asyncio.run(story())
