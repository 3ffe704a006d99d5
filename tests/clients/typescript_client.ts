// Uses a client that @hey-api/openapi-ts has made: node typescript_client.js URL TERRAIN.stl
import { readFileSync } from "node:fs";
import { client } from "./made/client.gen.js";
import * as api from "./made/sdk.gen.js";
import type { Rollout, Terrain } from "./made/types.gen.js";

const [url, path] = process.argv.slice(2) as [string, string];
client.setConfig({ baseUrl: url, throwOnError: true });

const file = new File([readFileSync(path)], "mesh.stl");
const imported = await api.importTerrain({ body: { file, y: 0 }, throwOnError: true });
const terrain: Terrain = imported.data;
const body = { terrain, method: "critical" as const };
const plan = (await api.createPlan({ body, throwOnError: true })).data;
const plan_id = plan.id;
const started = await api.createRollout({ body: { plan_id, seed: 3 }, throwOnError: true });
let job = started.data;
while (job.state === "queued" || job.state === "running") {
  await new Promise((resolve) => setTimeout(resolve, 50));
  job = (await api.getJob({ path: { job_id: job.id }, throwOnError: true })).data;
}
const rollout_id = (job.result ?? "").split("/").pop() ?? "";
const found = await api.getRollout({ path: { rollout_id }, throwOnError: true });
const run: Rollout = found.data;
const exported = async (format: "csv" | "npz") =>
  (
    await api.exportPlan({ path: { plan_id }, query: { format }, parseAs: "blob", throwOnError: true })
  ).data as Blob;
const mcap = (
  await api.exportRollout({
    path: { rollout_id },
    query: { format: "mcap" },
    parseAs: "blob",
    throwOnError: true,
  })
).data as Blob;
const refused = await api.createPlan({ body: { terrain: "nowhere" }, throwOnError: false });
const start = async (file: Blob) =>
  Buffer.from(await file.slice(0, 6).arrayBuffer()).toString("hex");
console.log(
  JSON.stringify({
    points: terrain.points,
    plan: plan.id,
    rollout: run.id,
    samples: [run.series.time.length, run.series.q.length, run.series.q[0]?.length],
    starts: [await start(await exported("csv")), await start(await exported("npz")), await start(mcap)],
    refused: refused.error?.type,
  }),
);
