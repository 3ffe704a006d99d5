/** Running a plan in the simulator: start, follow, cancel, and keep what came of it. */

import { batch, computed, signal } from "@preact/signals";
import {
  ApiError,
  cancelJob,
  getJob,
  getRollout,
  jobEvents,
  postPlan,
  postRollout,
} from "../api/client";
import type { Job, Plan, Rollout } from "../api/types";
import { report } from "./connection";
import { type Chunk, endLive, grow, startLive } from "./live";
import { plan, planB, request, settled, stale } from "./planning";
import { compare, controller, seed } from "./setup";

export type Activity = "idle" | "running" | "cancelled" | "failed";

export const run = signal<Rollout | null>(null);
export const runB = signal<Rollout | null>(null);
/** The plan that the shown rollout ran: it may be older than the shown plan. */
export const runPlan = signal<Plan | null>(null);
export const activity = signal<Activity>("idle");
/** Why a rollout could not be run (not: how it ended). */
export const failure = signal<string | null>(null);
/** Why B could not be run. */
export const failureB = signal<string | null>(null);
export const progress = signal(0);
export const eta = signal<number | null>(null);
/** Progress shows only for runs that take longer than a blink. */
export const showProgress = signal(false);

const BLINK = 300;
const POLL = 400;

/** An edit came after the rollout: results and plots describe the previous plan. */
export const runStale = computed(
  () =>
    run.value !== null &&
    (stale.value || (run.value.plan_id ?? runPlan.value?.id) !== plan.value?.id),
);
export const canRun = computed(
  () => plan.value?.status === "feasible" && activity.value !== "running",
);

let current: string | null = null;
let cancelled = false;

export async function startRollout(): Promise<void> {
  if (!canRun.peek()) return;
  await settled();
  const chosen = plan.peek();
  if (chosen?.status !== "feasible" || stale.peek()) return;
  cancelled = false;
  batch(() => {
    activity.value = "running";
    failure.value = null;
    progress.value = 0;
    eta.value = null;
  });
  const blink = setTimeout(() => {
    showProgress.value = true;
  }, BLINK);
  try {
    startLive(chosen);
    const done = await runOne(
      chosen,
      (value) => {
        progress.value = value;
      },
      grow,
    );
    batch(() => {
      endLive();
      run.value = done;
      runB.value = null;
      runPlan.value = chosen;
      activity.value = "idle";
    });
    await runOther();
  } catch (error) {
    report(error);
    activity.value = cancelled ? "cancelled" : "failed";
    if (!cancelled) failure.value = error instanceof Error ? error.message : String(error);
  } finally {
    endLive();
    clearTimeout(blink);
    showProgress.value = false;
    current = null;
  }
}

/** B after A; that it cannot be run is a result too, and no failure of A. */
async function runOther(): Promise<void> {
  const other = planB.peek();
  failureB.value = null;
  if (!compare.peek() || !other) return;
  if (other.problem && other.poses.length < 2) {
    failureB.value = other.problem.message;
    return;
  }
  try {
    runB.value = await runOne(other, () => undefined);
  } catch (error) {
    report(error);
    failureB.value = error instanceof Error ? error.message : String(error);
  }
}

export async function cancelRollout(): Promise<void> {
  cancelled = true;
  if (current) await cancelJob(current).catch(report);
}

async function runOne(
  which: Plan,
  onProgress: (value: number) => void,
  onSeries?: (chunk: Chunk) => void,
): Promise<Rollout> {
  const job = await submit(which);
  current = job.id;
  if (cancelled) await cancelJob(job.id);
  const onState = (state: Job) => {
    onProgress(state.progress);
    eta.value = state.eta;
  };
  const end = await follow(job, onState, onSeries);
  if (end.state === "cancelled") cancelled = true;
  if (end.state !== "done" || !end.result) {
    throw new Error(end.error?.detail ?? end.error?.title ?? `The rollout was ${end.state}.`);
  }
  return getRollout(end.result.split("/").pop()!);
}

async function submit(which: Plan): Promise<Job> {
  const body = {
    friction: which.friction,
    controller: controller.peek(),
    seed: seed.peek(),
  };
  try {
    return await postRollout({ plan_id: which.id, ...body });
  } catch (error) {
    // A service that was restarted may have forgotten the plan: ask for it again, once.
    const question = request.peek();
    if (!(error instanceof ApiError && error.status === 404 && question)) throw error;
    const again = await postPlan({ ...question, method: which.method });
    return postRollout({ plan_id: again.id, ...body });
  }
}

const over = (job: Job) => job.state !== "queued" && job.state !== "running";

/** Follow the job's events to its end; poll where the stream breaks. */
function follow(
  job: Job,
  onState: (job: Job) => void,
  onSeries?: (chunk: Chunk) => void,
): Promise<Job> {
  return new Promise((resolve, reject) => {
    const events = jobEvents(job.id);
    events.addEventListener("job", (event) => {
      const state = JSON.parse((event as MessageEvent<string>).data) as Job;
      onState(state);
      if (!over(state)) return;
      events.close();
      resolve(state);
    });
    if (onSeries) {
      events.addEventListener("series", (event) => {
        onSeries(JSON.parse((event as MessageEvent<string>).data) as Chunk);
      });
    }
    events.onerror = () => {
      events.close();
      poll(job.id, onState).then(resolve, reject);
    };
  });
}

async function poll(id: string, onState: (job: Job) => void): Promise<Job> {
  for (;;) {
    const state = await getJob(id);
    onState(state);
    if (over(state)) return state;
    await new Promise((wait) => setTimeout(wait, POLL));
  }
}

/** Show a stored rollout again, as a shared link asks for. */
export async function restoreRollout(id: string, id2: string | null): Promise<void> {
  const [first, second] = await Promise.all([getRollout(id), id2 ? getRollout(id2) : null]);
  batch(() => {
    run.value = first;
    runB.value = second;
    runPlan.value = plan.peek();
  });
}

export function forgetRollout(): void {
  batch(() => {
    run.value = null;
    runB.value = null;
    runPlan.value = null;
    activity.value = "idle";
    failure.value = null;
  });
}
