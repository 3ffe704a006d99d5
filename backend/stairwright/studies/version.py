"""Which code a study's answers depend on."""

from __future__ import annotations

from stairwright.jobs.engine import planning_engine, rollout_engine

from .document import Study


def engine_of(study: Study) -> str:
    """Fingerprint of that code: of the planner, and of the simulator where there are rollouts."""
    return planning_engine() if study.compute == "plan" else rollout_engine()
