"""The page's REST client is typed from the OpenAPI document and works with the running server."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from tests.conftest import Server

FRONTEND = Path(__file__).resolve().parents[2] / "frontend"

RUN = """
import { readFileSync, writeFileSync } from "node:fs";
import ts from "typescript";
const [source, target, url] = process.argv.slice(2);
const made = ts.transpileModule(readFileSync(source, "utf8"), {
  compilerOptions: { module: "ESNext", target: "ES2022" },
});
writeFileSync(target, made.outputText);
const plain = globalThis.fetch;
globalThis.fetch = (path, init) => plain(new URL(path, url), init);  // as a page of the server's
const api = await import(target);
const terrain = { points: [[-1, 0], [0, 0], [0, 0.05], [1, 0.05]] };
const robots = (await api.getRobots()).map(robot => robot.name);
const plan = await api.postPlan({ terrain, robot: robots[0], method: "critical" });
const asked = { plan_id: plan.id, friction: 0.6, seed: 3 };
let job = await api.postRollout(asked);
while (["queued", "running"].includes(job.state)) {
  await new Promise(resolve => setTimeout(resolve, 30));
  job = await api.getJob(job.id);
}
const rollout = await api.getRollout(job.result.split("/").pop());
let refused;
try {
  await api.postPlan({ terrain: { points: [[1, 0], [0, 0]] }, robot: robots[0] });
} catch (error) {
  refused = { status: error.status, message: error.message };
}
const settings = Object.keys((await api.getSettings()).weights);
console.log(JSON.stringify({ robots, plan: plan.id, run: rollout.id, refused, settings }));
"""


def node() -> str:
    found = shutil.which("node")
    if found is None or not (FRONTEND / "node_modules").is_dir():
        pytest.fail("No Node or no packages for the page here: run ./dev test.")
    return found


@pytest.mark.slow
def test_types_are_in_step_with_the_interface(server: Server, tmp_path: Path) -> None:
    made = tmp_path / "schema.d.ts"
    address = f"{server.url}/api/v1/openapi.json"
    command = [node(), "types.mjs", address, made]
    subprocess.run(command, cwd=FRONTEND, check=True, capture_output=True)
    kept = (FRONTEND / "src" / "api" / "schema.d.ts").read_text()
    assert made.read_text() == kept, "npm run types, in frontend/, with the server running"


@pytest.mark.slow
def test_the_client_talks_to_the_server(server: Server, tmp_path: Path) -> None:
    script = FRONTEND / "node_modules" / ".client-test.mjs"  # where `typescript` is found
    script.write_text(RUN)
    source = FRONTEND / "src" / "api" / "client.ts"
    try:
        ended = subprocess.run(
            [node(), script, source, tmp_path / "client.mjs", server.url],
            check=False, capture_output=True, text=True, timeout=120,
        )  # fmt: skip
    finally:
        script.unlink()
    assert ended.returncode == 0, ended.stderr
    told: dict[str, Any] = json.loads(ended.stdout)
    assert {"a1_wheeled", "a1_wheeled_x"} <= set(told["robots"])
    assert told["plan"].startswith("p-")
    assert told["run"].startswith("r-")
    assert told["refused"]["status"] == 422
    assert told["refused"]["message"].startswith("terrain.points")
    assert set(told["settings"]) == {"path", "critical", "nominal"}
