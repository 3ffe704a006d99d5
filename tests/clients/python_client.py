"""Uses a client that openapi-python-client has made: python python_client.py URL TERRAIN.stl."""

from __future__ import annotations

import json
import sys
import time
from io import BytesIO
from pathlib import Path
from typing import Any

from made import Client
from made.api.jobs import get_job
from made.api.plans import create_plan, export_plan, get_plan
from made.api.rollouts import create_rollout, export_rollout, get_rollout
from made.api.terrains import import_terrain
from made.models import (
    BodyImportTerrain,
    ExportPlanFormat,
    ExportRolloutFormat,
    PlanRequest,
    PlanRequestMethod,
    Problem,
    ProblemDocument,
    RolloutRequest,
    Terrain,
)
from made.types import File

url, path = sys.argv[1], Path(sys.argv[2])
client = Client(base_url=url, raise_on_unexpected_status=True)
upload = File(BytesIO(path.read_bytes()), file_name=path.name, mime_type="model/stl")
terrain: Any = import_terrain.sync(client=client, body=BodyImportTerrain(file=upload, y=0.0))
assert isinstance(terrain, Terrain), terrain
question = PlanRequest(terrain=terrain, method=PlanRequestMethod.CRITICAL)
plan: Any = create_plan.sync(client=client, body=question)
assert plan.problem is None or not isinstance(plan.problem, Problem), plan.problem
assert get_plan.sync(plan.id, client=client) == plan
csv: Any = export_plan.sync(plan.id, client=client, format_=ExportPlanFormat.CSV)
npz: Any = export_plan.sync(plan.id, client=client, format_=ExportPlanFormat.NPZ)

job: Any = create_rollout.sync(client=client, body=RolloutRequest(plan_id=plan.id, seed=3))
while job.state in ("queued", "running"):
    time.sleep(0.05)
    job = get_job.sync(job.id, client=client)
assert job.state == "done", job.error
run: Any = get_rollout.sync(job.result.rsplit("/", 1)[-1], client=client)
mcap: Any = export_rollout.sync(run.id, client=client, format_=ExportRolloutFormat.MCAP)
refused = create_plan.sync(client=client, body=PlanRequest(terrain="nowhere"))
assert isinstance(refused, ProblemDocument), refused
told = {
    "points": terrain.points,
    "plan": plan.id,
    "rollout": run.id,
    "samples": [len(run.series.time), len(run.series.q), len(run.series.q[0])],
    "starts": [f.payload.read(6).hex() for f in (csv, npz, mcap)],
    "refused": refused.type_,
}
print(json.dumps(told))
