/** Running a plan in the simulator: start, follow, cancel, and keep what came of it. */

import { batch, computed, signal } from "@preact/signals";
import {
  ApiError,
  cancelJob,
  getJob,
  getPlan,
  getRollout,
  jobEvents,
  Offline,
  postPlan,
  postRollout,
  type RolloutRequest,
  reasonOf,
} from "../api/client";
import type { Job, Plan, PlanRequest, Rollout } from "../api/types";
import { report } from "./connection";
import { type Chunk, endLive, grow, haltLive, livePlan, startLive } from "./live";
import { plan, refusal, settled, stale } from "./planning";
import { request, simpler } from "./question";
import { compare, controller, disturbance, seed } from "./setup";
import { remember, wasUnderWay } from "./under-way";

export type Activity = "idle" | "running" | "cancelled" | "failed";

export const run = signal<Rollout | null>(null);
export const runB = signal<Rollout | null>(null);
/** The plan that the shown rollout ran: it may be older than the shown plan. */
export const runPlan = signal<Plan | null>(null);
export const runPlanB = signal<Plan | null>(null);
export const activity = signal<Activity>("idle");
/** Why a rollout could not be run (not: how it ended). */
export const failure = signal<string | null>(null);
/** Why B could not be run. */
export const failureB = signal<string | null>(null);
export const progress = signal(0);
export const eta = signal<number | null>(null);
/** Progress shows only for runs that take longer than a blink. */
export const showProgress = signal(false);

/** Which of the two is under way, once that shows. */
export const running = computed(() => {
  if (activity.value !== "running" || !showProgress.value) return null;
  return livePlan.value ? "a" : "b";
});

const BLINK = 300;
const POLL = 400;

/** What a rollout is asked besides its plan. */
type Setup = Pick<RolloutRequest, "seed" | "controller" | "disturbance">;
const setup = computed<Setup>(() => ({
  seed: seed.value,
  controller: controller.value,
  disturbance: disturbance.value,
}));
const runSetup = signal<Setup>(setup.peek());

const inOrder = ({ seed, controller, disturbance }: Setup) =>
  JSON.stringify([seed, Object.entries(controller).sort(), Object.entries(disturbance).sort()]);
const sameSetup = (a: Setup, b: Setup) => inOrder(a) === inOrder(b);

/** A change came after the rollout: what results and plots describe is not what is set up now. */
export const runOf = computed(() => {
  if (!run.value) return null;
  if (stale.value || (run.value.plan_id ?? runPlan.value?.id) !== plan.value?.id) {
    return "previous plan";
  }
  return sameSetup(runSetup.value, setup.value) ? null : "previous settings";
});
export const runStale = computed(() => runOf.value !== null);
export const canRun = computed(
  () => plan.value?.status === "feasible" && !refusal.value && activity.value !== "running",
);

/** The job under way: A and, while comparing, B. Once given up it changes nothing any more. */
let job = new AbortController();
let blink: ReturnType<typeof setTimeout> | undefined;

/** @param under a job that is at it already */
export async function startRollout(under?: string): Promise<void> {
  await settled();
  const chosen = plan.peek();
  const question = request.peek();
  if (!chosen || !question || stale.peek() || !canRun.peek()) return;
  const asked = setup.peek();
  const { signal } = begin(chosen);
  try {
    const job = under ?? (await submit(chosen, asked)).id;
    remember("rollout", { job, plan: chosen.id });
    const done = await arrival(job, signal, grow);
    batch(() => {
      forgetResults();
      run.value = done;
      runPlan.value = chosen;
      runSetup.value = asked;
      endLive();
    });
    if (compare.peek()) await runOther(question, asked, signal);
    if (!signal.aborted) finish("idle");
  } catch (error) {
    if (signal.aborted) return;
    report(error);
    failure.value = sentence(error);
    finish("failed", error instanceof Offline);
  }
}

/** After a reload: the rollout that this tab waited for. */
export async function resumeRollout(): Promise<void> {
  const under = await wasUnderWay("rollout");
  if (under) await startRollout(under.job);
}

function begin(chosen: Plan): AbortController {
  job = new AbortController();
  blink = setTimeout(() => {
    showProgress.value = true;
  }, BLINK);
  batch(() => {
    activity.value = "running";
    failure.value = null;
    progress.value = 0;
    eta.value = null;
    startLive(chosen);
  });
  return job;
}

/**
 * A run that did not get to its end leaves what was driven, or the plan, but not an older run.
 * @param lost only this page has lost it: a reload finds it again
 */
function finish(how: Activity, lost = false): void {
  clearTimeout(blink);
  if (!lost) remember("rollout", null);
  batch(() => {
    activity.value = how;
    showProgress.value = false;
    if (how === "cancelled") haltLive();
    else endLive();
    if (how !== "idle") forgetResults();
  });
}

/** B after A; that it cannot be run is a result too, and no failure of A. */
async function runOther(question: PlanRequest, asked: Setup, signal: AbortSignal): Promise<void> {
  try {
    progress.value = 0;
    const other = await postPlan(simpler(question, "nominal", runPlan.peek()), signal);
    if (other.problem && other.poses.length < 2) throw new Error(other.problem.message);
    const done = await arrival((await submit(other, asked)).id, signal);
    batch(() => {
      runB.value = done;
      runPlanB.value = other;
    });
  } catch (error) {
    if (signal.aborted) return;
    report(error);
    failureB.value = sentence(error);
  }
}

/** Gives up what is under way: A with all of it, B alone where A has arrived. */
export function cancelRollout(): void {
  job.abort();
  if (running.peek() === "b") {
    failureB.value = "it was cancelled.";
    finish("idle");
  } else {
    finish("cancelled");
  }
}

/** What comes of a job; where it is given up meanwhile, it is cancelled. */
async function arrival(
  id: string,
  signal: AbortSignal,
  onSeries?: (chunk: Chunk) => void,
): Promise<Rollout> {
  try {
    signal.throwIfAborted();
    const end = await follow(id, signal, onSeries);
    if (end.state !== "done" || !end.result) {
      throw new Error(end.error?.detail ?? end.error?.title ?? `The rollout was ${end.state}.`);
    }
    const done = await getRollout(end.result.split("/").pop()!);
    signal.throwIfAborted();
    return done;
  } catch (error) {
    if (signal.aborted) await cancelJob(id).catch(report);
    throw error;
  }
}

async function submit(which: Plan, asked: Setup): Promise<Job> {
  const body = { friction: which.friction, ...asked };
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

/** True long after, too: when the service is back, the run is not. */
const LOST = "The connection to the service broke and the run is lost. It can be started again.";

function sentence(error: unknown): string {
  if (error instanceof Offline) return LOST;
  return reasonOf(error);
}

const over = (job: Job) => job.state !== "queued" && job.state !== "running";

function onState(state: Job): void {
  progress.value = state.progress;
  eta.value = state.eta;
}

/** Follow the job's events to its end; poll where the stream breaks. */
function follow(id: string, signal: AbortSignal, onSeries?: (chunk: Chunk) => void): Promise<Job> {
  return new Promise((resolve, reject) => {
    const events = jobEvents(id);
    signal.addEventListener("abort", () => {
      events.close();
      reject(signal.reason);
    });
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
      poll(id, signal).then(resolve, reject);
    };
  });
}

async function poll(id: string, signal: AbortSignal): Promise<Job> {
  for (;;) {
    const state = await getJob(id);
    signal.throwIfAborted();
    onState(state);
    if (over(state)) return state;
    await new Promise((wait) => setTimeout(wait, POLL));
  }
}

/** Null where the service no longer has it. */
const planOf = (rollout: Rollout | null): Promise<Plan | null> | null =>
  rollout?.plan_id ? getPlan(rollout.plan_id).catch(() => null) : null;

/** Show a stored rollout again, as a shared link asks for. */
export async function restoreRollout(id: string, id2: string | null): Promise<void> {
  const [first, second] = await Promise.all([getRollout(id), id2 ? getRollout(id2) : null]);
  const plans = await Promise.all([planOf(first), planOf(second)]);
  batch(() => {
    run.value = first;
    runB.value = second;
    [runPlan.value, runPlanB.value] = plans;
    runSetup.value = setup.peek();
  });
}

function forgetResults(): void {
  run.value = null;
  runB.value = null;
  runPlan.value = null;
  runPlanB.value = null;
  failureB.value = null;
}

/** Another terrain: neither what came of the last rollout nor one under way means anything to it. */
export function forgetRollout(): void {
  job.abort();
  batch(() => {
    forgetResults();
    failure.value = null;
    finish("idle");
  });
}
