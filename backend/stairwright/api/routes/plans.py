"""Plans: ask for one."""

from __future__ import annotations

from fastapi import APIRouter

from ...planning.plan import Plan
from ..bodies import PlanRequest

router = APIRouter(prefix="/plans", tags=["plans"])


@router.post("")
def post_plan(body: PlanRequest) -> Plan:
    """Plan; the answer is the plan, an infeasible one too."""
    from ...planning.planner import plan

    return plan(body.terrain, body.robot, body.friction, body.method, body.weights)
