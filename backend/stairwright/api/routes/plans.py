"""Plans: ask for one."""

from __future__ import annotations

from fastapi import APIRouter

from stairwright.api.bodies import PlanRequest
from stairwright.planning.plan import Plan

router = APIRouter(prefix="/plans", tags=["plans"])


@router.post("")
def post_plan(body: PlanRequest) -> Plan:
    """Plan; the answer is the plan, an infeasible one too."""
    from stairwright.planning.planner import plan

    return plan(body.terrain, body.robot, body.friction, body.method, body.weights)
