/**
 * Live planning: each change asks, the newest answer shows, one solve runs at a time. Where the
 * full path takes longer than a hand waits, the paper's few poses come first and the path follows.
 */

import { batch, computed, effect, type ReadonlySignal, type Signal, signal } from "@preact/signals";
import { postPlan } from "../api/client";
import { connectLive, livePlan } from "../api/live";
import { NewestWins } from "../api/newest-wins";
import type { Method, Plan, PlanRequest } from "../api/types";
import { connected, report } from "./connection";
import { drawing, isEmpty, terrainDocument } from "./drawing";
import { Pace } from "./pace";
import { changedWeights, compare, method, robotSource, robots, settings, timing } from "./setup";

/** Shorter waits show no spinner: it would only flicker [ms]. */
const PATIENCE = 150;
/** The path follows a preview once the hand has rested for this long [ms]. */
const REST = 100;
/** A path that has run for this long gives way to a newer question in any case [ms]. */
const LONGEST = 400;

export const plan = signal<Plan | null>(null);
/** B of the comparison: the same terrain without pose optimisation. */
export const planB = signal<Plan | null>(null);
/**
 * The paper's poses for what is drawn now, while `plan` still answers an older question: they
 * follow the hand, and all that only a full path can tell keeps still until it comes.
 */
export const preview = signal<Plan | null>(null);
/** While poses are previewed: the older plan is of the same corners, and can stay as it is. */
export const planKept = computed(
  () => !preview.value || preview.value.terrain.points.length === plan.value?.terrain.points.length,
);
/** Why the service refused the question itself (not: why the terrain is infeasible). */
export const refusal = signal<string | null>(null);
/** From asking for the shown plan to having it [s]. */
export const answered = signal(0);
/** The newest question has waited for longer than anyone would overlook. */
export const slow = signal(false);
export const waited = signal(0);

const shownKey = signal("");

interface Question {
  /** When the drawing asked [ms]. */
  asked: number;
  which: "preview" | "a" | "b";
  request: PlanRequest;
  /** Of the question that was meant: the request of A as text. */
  key: string;
  /** Who asked besides A. */
  follower?: Follower;
}

/** A second question beside the plan's, such as another robot's on the same terrain. */
interface Follower {
  request: ReadonlySignal<PlanRequest | null>;
  answer: Signal<Plan | null>;
  /** The answer is to an older question. */
  pending: Signal<boolean>;
  /** The last question that was answered, as text. */
  key: string;
}

export const request = computed<PlanRequest | null>(() => {
  if (isEmpty.value || robots.value.length === 0 || !settings.value) return null;
  return ask(method.value, changedWeights.value);
});
const requestKey = computed(() => JSON.stringify(request.value));

/** The shown plan answers an older question than the one on screen. */
export const stale = computed(() => shownKey.value !== requestKey.value);
/** It does so for longer than anyone would overlook: with a slow answer, or none for now. */
export const outdated = computed(() =>
  connected.value ? slow.value && !preview.value : stale.value,
);

/** What another robot would be asked on the same terrain. */
export const requestWith = (robot: PlanRequest["robot"]): PlanRequest | null =>
  request.value && { ...request.value, robot };

function ask(by: Method, weights: PlanRequest["weights"]): PlanRequest {
  const state = drawing.value;
  return {
    terrain: terrainDocument(state),
    robot: robotSource.value,
    friction: state.friction,
    method: by,
    ...(by === "path" && timing.value === "fast" ? { timing: "fast" as const } : {}),
    ...(weights && Object.keys(weights).length > 0 ? { weights } : {}),
  };
}

let timer: ReturnType<typeof setTimeout> | undefined;
let ticker: ReturnType<typeof setInterval> | undefined;

function startWaiting(): void {
  if (timer) return;
  const since = performance.now();
  timer = setTimeout(() => {
    slow.value = true;
    waited.value = PATIENCE / 1000;
    ticker = setInterval(() => {
      waited.value = (performance.now() - since) / 1000;
    }, 100);
  }, PATIENCE);
}

function stopWaiting(): void {
  clearTimeout(timer);
  clearInterval(ticker);
  timer = undefined;
  slow.value = false;
}

const pace = new Pace();
let resting: ReturnType<typeof setTimeout> | undefined;
let stirred = Number.NEGATIVE_INFINITY;

/** The hand is at work, even where its moves change nothing yet (snapping). */
export function stir(): void {
  stirred = performance.now();
}
/** The last question to the quick method, as text. */
let previewed = "";

const queue = new NewestWins<Question, Plan>({ solve, show, fail, yields });

async function solve(question: Question, abort: AbortSignal): Promise<Plan> {
  const started = performance.now();
  const { method } = question.request;
  // Quick answers are small and many; long ones are better compressed, as HTTP does it.
  const answer = await (method === "critical"
    ? livePlan(question.request, question.which !== "preview", abort)
    : postPlan(question.request, abort));
  const trip = performance.now() - started;
  if (method !== "nominal") pace.measured(method === "path" ? "full" : "quick", trip, answer);
  return answer;
}

/** A path gives way to newer poses, unless those have been no help: then it is all there is. */
function yields(running: Question, next: Question, since: number): boolean {
  if (running.which === "b") return next.which !== "b";
  if (running.which !== "a" || next.which !== "preview") return false;
  return pace.finds || since > LONGEST;
}

function show(answer: Plan, question: Question, newest: boolean): void {
  if (question.follower) {
    answerFollower(question.follower, question.key, answer);
    return;
  }
  markDrawn(question.asked);
  if (question.which === "preview") showPreview(answer, question, newest);
  else showPlan(answer, question, newest);
}

/** For the benchmark of dragging: after the frame that is drawn with this answer. */
function markDrawn(detail: number): void {
  requestAnimationFrame(() => {
    setTimeout(() => performance.mark("stairwright:poses", { detail }));
  });
}

function showPreview(answer: Plan, question: Question, newest: boolean): void {
  // Where the quick method finds no way, the path may: only good news is worth showing early.
  pace.finds = answer.status === "feasible";
  if (pace.finds) preview.value = answer;
  if (!newest) return;
  if (pace.finds) stopWaiting();
  askForPath(question, pace.finds);
}

function showPlan(answer: Plan, question: Question, newest: boolean): void {
  batch(() => {
    plan.value = answer;
    answered.value = (performance.now() - question.asked) / 1000;
    preview.value = null;
    shownKey.value = question.key;
    refusal.value = null;
  });
  if (!newest) return;
  stopWaiting();
  askFollowers();
}

/** The question that the quick method is asked: the same without the full method's weights. */
function quick(question: PlanRequest): PlanRequest {
  const { weights: _, timing: __, ...rest } = question;
  return { ...rest, method: "critical" };
}

function askForA(request: PlanRequest, key: string): void {
  clearTimeout(resting);
  const asked = performance.now();
  if (request.method === "path" && pace.worthPreview) {
    const easier = quick(request);
    const text = JSON.stringify(easier);
    // A weight of the path changes nothing that the quick method could tell.
    if (text !== previewed) {
      previewed = text;
      queue.ask({ which: "preview", asked, request: easier, key });
      return;
    }
  }
  queue.ask({ which: "a", request, key, asked });
}

/** After the preview, once the hand rests: the question that was meant. */
function askForPath(before: Question, patient: boolean): void {
  clearTimeout(resting);
  const wait = patient ? stirred + REST - performance.now() : 0;
  if (wait > 0) {
    resting = setTimeout(() => askForPath(before, true), wait);
    return;
  }
  const meant = request.peek();
  if (!meant || requestKey.peek() !== before.key) return;
  startWaiting();
  queue.ask({ which: "a", request: meant, key: before.key, asked: before.asked });
}

/** The question of B: the same without pose optimisation. */
export function unoptimised(question: PlanRequest): PlanRequest {
  const { weights: _, timing: __, ...rest } = question;
  return { ...rest, method: "nominal" };
}

const followers: Follower[] = [];

/** Keep `answer` the answer to `request` from now on; A goes first, one solve runs at a time. */
export function follow(
  request: Follower["request"],
  answer: Follower["answer"],
  pending: Follower["pending"] = signal(false),
): () => void {
  const follower = { request, answer, pending, key: "" };
  followers.push(follower);
  const stop = effect(() => {
    if (request.value) {
      pending.value = JSON.stringify(request.value) !== follower.key;
      if (!stale.value && connected.value) askFollowers();
    } else {
      answer.value = null;
      follower.key = "";
    }
  });
  return () => {
    stop();
    followers.splice(followers.indexOf(follower), 1);
  };
}

/** The first of them whose answer is not the one to its question. */
function askFollowers(): void {
  if (stale.peek()) return;
  for (const follower of followers) {
    const request = follower.request.peek();
    const key = JSON.stringify(request);
    if (!request || key === follower.key) continue;
    queue.ask({ which: "b", asked: performance.now(), request, key, follower });
    return;
  }
}

function answerFollower(follower: Follower, key: string, answer: Plan | null): void {
  if (key === JSON.stringify(follower.request.peek())) {
    follower.key = key;
    follower.answer.value = answer;
    follower.pending.value = false;
  }
  askFollowers();
}

function fail(error: unknown, question: Question, newest: boolean): void {
  report(error);
  if (question.follower) {
    if (connected.peek()) answerFollower(question.follower, question.key, null);
    return;
  }
  if (!newest) return;
  if (question.which === "preview" && connected.peek()) {
    pace.finds = false;
    askForPath(question, false);
    return;
  }
  stopWaiting();
  if (!connected.peek()) return;
  batch(() => {
    refusal.value = error instanceof Error ? error.message : String(error);
    preview.value = null;
  });
}

function forget(): void {
  clearTimeout(resting);
  queue.forget();
  preview.value = null;
  previewed = "";
  stopWaiting();
}

/** Follow every change of drawing and set-up from now on. */
export function startPlanning(): () => void {
  connectLive();
  const stopA = effect(() => {
    // By its text: a drag that stays on its grid point is a new drawing, but no new question.
    const key = requestKey.value;
    const question = request.peek();
    if (!question) {
      forget();
      batch(() => {
        plan.value = null;
        refusal.value = null;
        shownKey.value = key;
      });
      return;
    }
    if (!connected.value) return;
    if (key === shownKey.peek()) {
      // Back to what is shown already (undo, reset): what was asked meanwhile must not replace it.
      forget();
      refusal.value = null;
      return;
    }
    startWaiting();
    askForA(question, key);
  });
  const nominal = computed(() =>
    compare.value && request.value ? unoptimised(request.value) : null,
  );
  const stopB = follow(nominal, planB);
  return () => {
    stopA();
    stopB();
  };
}

/** Resolves when the shown plan answers what is on screen; at once where nothing is asked. */
export function settled(): Promise<void> {
  return new Promise((resolve) => {
    const stop = effect(() => {
      if (stale.value && !refusal.value && connected.value) return;
      queueMicrotask(() => stop());
      resolve();
    });
  });
}
