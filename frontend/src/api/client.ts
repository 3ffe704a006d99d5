/** One function a REST call. Throws `ApiError` for an answer that says no, `Offline` for none. */

import type {
  ImportedRobot,
  Job,
  MeshHeights,
  Plan,
  PlanRequest,
  ProblemDetail,
  RobotDocument,
  Rollout,
  SentRobot,
  Settings,
  SettingValues,
  TerrainDocument,
  Trials,
} from "./types";

export const BASE = "/api/v1";

export class ApiError extends Error {
  constructor(
    readonly status: number,
    readonly problem: ProblemDetail,
  ) {
    super(sentence(problem, status));
  }
}

/** The service did not answer at all: stopped, restarting, or the network is gone. */
export class Offline extends Error {}

/** What went wrong, in a sentence. */
export const reasonOf = (error: unknown) =>
  error instanceof Error ? error.message : String(error);

function sentence(problem: ProblemDetail, status: number): string {
  const first = problem.errors?.[0];
  if (first) return first.field ? `${first.field}: ${first.message}` : first.message;
  return problem.detail ?? problem.title ?? `The service answered ${status}.`;
}

export async function call(
  method: string,
  path: string,
  body?: unknown,
  signal?: AbortSignal,
): Promise<Response> {
  const init: RequestInit = { method, ...(signal ? { signal } : {}) };
  if (body instanceof FormData) init.body = body;
  else if (body !== undefined) {
    init.body = JSON.stringify(body);
    init.headers = { "Content-Type": "application/json" };
  }
  let response: Response;
  try {
    response = await fetch(`${BASE}/${path}`, init);
  } catch (error) {
    if (signal?.aborted) throw error;
    throw new Offline("The service does not answer.");
  }
  if (response.ok) return response;
  if (response.status === 502 || response.status === 504) throw new Offline("No answer.");
  const problem = (await response.json().catch(() => ({}))) as ProblemDetail;
  throw new ApiError(response.status, problem);
}

export async function callJson<T>(
  method: string,
  path: string,
  body?: unknown,
  signal?: AbortSignal,
): Promise<T> {
  return (await (await call(method, path, body, signal)).json()) as T;
}

export const getTerrains = () => callJson<TerrainDocument[]>("GET", "terrains");
export const getRobots = () => callJson<RobotDocument[]>("GET", "robots");
export const getSettings = () => callJson<Settings>("GET", "settings");
export const getPlan = (id: string) => callJson<Plan>("GET", `plans/${id}`);
export const getPlanRobot = (id: string) => callJson<SentRobot>("GET", `plans/${id}/robot`);
export const getRollout = (id: string) => callJson<Rollout>("GET", `rollouts/${id}`);
export const getJob = (id: string) => callJson<Job>("GET", `jobs/${id}`);
export const postPlan = (request: PlanRequest, signal?: AbortSignal) =>
  callJson<Plan>("POST", "plans", request, signal);

export async function ping(): Promise<number> {
  const started = performance.now();
  await call("GET", "healthz");
  return performance.now() - started;
}

export const putTerrain = (terrain: TerrainDocument) => {
  const { readonly: _, ...document } = terrain;
  return callJson<TerrainDocument>("PUT", `terrains/${encodeURIComponent(terrain.name)}`, document);
};

export const deleteTerrain = (name: string) =>
  call("DELETE", `terrains/${encodeURIComponent(name)}`);

export const putRobot = (robot: SentRobot) =>
  callJson<RobotDocument>("PUT", `robots/${encodeURIComponent(robot.name)}`, robot);

export const deleteRobot = (name: string) => call("DELETE", `robots/${encodeURIComponent(name)}`);

function sent(file: File, fields: Record<string, string | string[]>): FormData {
  const form = new FormData();
  form.append("file", file, file.name);
  for (const [name, value] of Object.entries(fields))
    for (const one of [value].flat()) form.append(name, one);
  return form;
}

/** `hold` lists joints that count as rigid, as `name=position`. */
export const importRobot = (file: File, hold: string[], abort?: AbortSignal) =>
  callJson<ImportedRobot>("POST", "robots/import", sent(file, { hold }), abort);

/** A robot as a file for other tools, whether it is saved or not. */
export async function robotFile(robot: SentRobot, format: string): Promise<Blob> {
  return (await call("POST", `robots/export?format=${encodeURIComponent(format)}`, robot)).blob();
}

export const generateTerrain = (parameters: Record<string, unknown>) =>
  callJson<TerrainDocument>("POST", "terrains/generate", parameters);

export function importTerrain(file: File, fields: Record<string, string>, abort?: AbortSignal) {
  return callJson<TerrainDocument>("POST", "terrains/import", sent(file, fields), abort);
}

/** A mesh from above, in units of the file. */
export const lookAtMesh = (file: File, up: "z" | "y") =>
  callJson<MeshHeights>("POST", "terrains/import/heights", sent(file, { up }));

export interface RolloutRequest {
  plan_id: string;
  friction: number;
  controller: SettingValues;
  seed: number;
  disturbance: SettingValues;
}

export const postRollout = (request: RolloutRequest) => callJson<Job>("POST", "rollouts", request);

export interface TrialsRequest extends Omit<RolloutRequest, "disturbance"> {
  count: number;
  /** Name of the ranges that deviations are drawn from. */
  bundle: string;
}

export const postTrials = (request: TrialsRequest) => callJson<Job>("POST", "trials", request);
export const getTrials = (id: string) => callJson<Trials>("GET", `trials/${id}`);
export const cancelJob = (id: string) => call("DELETE", `jobs/${id}`);
export const jobEvents = (id: string) => new EventSource(`${BASE}/jobs/${id}/events`);

export interface Session {
  id: string;
  scene: string;
}

export const postSession = () => callJson<Session>("POST", "sessions");
export const putScene = (id: string, body: Record<string, unknown>) =>
  call("PUT", `sessions/${id}/scene`, body);
export const putPlayback = (id: string, body: Record<string, unknown>) =>
  call("PUT", `sessions/${id}/playback`, body);

/** The page is going away: the request must outlive it. */
export function dropSession(id: string): void {
  void fetch(`${BASE}/sessions/${id}`, { method: "DELETE", keepalive: true });
}

export const exportPath = (kind: "plans" | "rollouts", id: string, format: string) =>
  `${kind}/${encodeURIComponent(id)}/export?format=${format}`;

export const exportUrl = (...of: Parameters<typeof exportPath>) => `${BASE}/${exportPath(...of)}`;
