/** A set of trials of the shown plan: start, follow, cancel, and replay one of them. */

import { batch, computed, signal } from "@preact/signals";
import { cancelJob, getJob, getTrials, Offline, postTrials, reasonOf } from "../api/client";
import type { Job, SettingValues, Trial, Trials } from "../api/types";
import { report } from "./connection";
import { plan, settled, stale } from "./planning";
import { canRun, startRollout } from "./rollouts";
import { controller, disturbance, disturbanceSchema, seed } from "./setup";
import { remember, type UnderWay, wasUnderWay } from "./under-way";
import { inspectorPage } from "./view";

/** What trials draw their deviations from; none: there is only the single rollout. */
export const bundle = signal<string | null>(null);
export const count = signal(29);
/** As the service takes them. */
export const MOST_TRIALS = 1000;

/** The job under way. */
const job = signal<Job | null>(null);
export const trialsRunning = computed(() => job.value !== null);
export const trialsProgress = computed(() => job.value?.progress ?? 0);
/** [s] */
export const trialsEta = computed(() => job.value?.eta ?? null);
export const trials = signal<Trials | null>(null);
/** Why there is no result. */
export const trialsFailure = signal<string | null>(null);
/** They are of another plan than the one shown. */
export const trialsStale = computed(
  () => trials.value !== null && (stale.value || trials.value.plan_id !== plan.value?.id),
);
export const canTry = computed(
  () => plan.value?.status === "feasible" && !trialsRunning.value && !stale.value,
);

const POLL = 400;
let given = new AbortController();

const over = (state: Job["state"]) => state !== "queued" && state !== "running";

/** As a reload finds them again. */
interface TrialsUnderWay extends UnderWay {
  bundle: string;
  count: number;
}

/** @param under a job that is at them already */
export async function startTrials(under?: string): Promise<void> {
  await settled();
  const shown = plan.peek();
  const from = bundle.peek();
  if (!shown || !from || !canTry.peek()) return;
  given = new AbortController();
  const { signal: stop } = given;
  trialsFailure.value = null;
  const body = {
    plan_id: shown.id,
    friction: shown.friction,
    controller: controller.peek(),
    seed: seed.peek(),
    count: count.peek(),
    bundle: from,
  };
  try {
    const asked = await (under ? getJob(under) : postTrials(body));
    if (stop.aborted) return void (await cancelJob(asked.id));
    job.value = asked;
    remember<TrialsUnderWay>("trials", {
      job: asked.id,
      plan: shown.id,
      bundle: from,
      count: body.count,
    });
    const end = await follow(asked, stop);
    if (end.state !== "done" || !end.result) {
      throw new Error(end.error?.detail ?? end.error?.title ?? `The trials were ${end.state}.`);
    }
    trials.value = await getTrials(end.result.split("/").pop()!);
  } catch (error) {
    if (stop.aborted) return;
    report(error);
    trialsFailure.value = reasonOf(error);
    if (error instanceof Offline) return;
  } finally {
    if (!stop.aborted) job.value = null;
  }
  remember("trials", null);
}

/** After a reload: the trials that this tab waited for. */
export async function resumeTrials(): Promise<void> {
  const under = await wasUnderWay<TrialsUnderWay>("trials");
  if (!under) return;
  batch(() => {
    bundle.value = under.bundle;
    count.value = under.count;
    inspectorPage.value = "trials";
  });
  await startTrials(under.job);
}

async function follow(asked: Job, stop: AbortSignal): Promise<Job> {
  let state = asked;
  while (!over(state.state)) {
    await new Promise((wait) => setTimeout(wait, POLL));
    stop.throwIfAborted();
    state = await getJob(asked.id);
    stop.throwIfAborted();
    job.value = state;
  }
  return state;
}

export function cancelTrials(): void {
  const under = job.peek();
  given.abort();
  job.value = null;
  remember("trials", null);
  if (under) cancelJob(under.id).catch(report);
}

/** Failures first, then the largest pitch errors. */
export const worstTrials = computed<Trial[]>(() => {
  const failed = (trial: Trial) => (trial.outcome === "success" ? 0 : 1);
  return [...(trials.value?.trials ?? [])].sort(
    (a, b) => failed(b) - failed(a) || b.pitch_error_max - a.pitch_error_max,
  );
});

/** Its deviations without those that are nothing. */
export function deviations(trial: Trial): SettingValues {
  const known = disturbanceSchema.peek();
  return Object.fromEntries(
    Object.entries(trial.disturbance).filter(
      ([name, value]) => typeof value === "number" && value !== known[name]?.default,
    ),
  ) as SettingValues;
}

/** The same rollout once more, to look at. */
export function replay(trial: Trial): void {
  if (!canRun.peek()) return;
  batch(() => {
    seed.value = trial.seed;
    disturbance.value = deviations(trial);
  });
  void startRollout();
}
