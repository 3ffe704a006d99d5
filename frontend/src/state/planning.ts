/**
 * Live planning: each change asks, the newest answer shows, one solve runs at a time. Where the
 * full path takes longer than a hand waits, the paper's few poses come first and the path follows.
 */

import { batch, computed, effect, signal } from "@preact/signals";
import { postPlan } from "../api/client";
import { NewestWins } from "../api/newest-wins";
import type { Method, Plan, PlanRequest } from "../api/types";
import { connected, report } from "./connection";
import { drawing, isEmpty, terrainDocument } from "./drawing";
import { changedWeights, compare, method, robotName, robots, settings } from "./setup";

/** Shorter waits show no spinner: it would only flicker [ms]. */
const PATIENCE = 150;
/** A path that takes longer than this is worth a preview [ms]. */
const LIVE = 120;

export const plan = signal<Plan | null>(null);
/** B of the comparison: the same terrain without pose optimisation. */
export const planB = signal<Plan | null>(null);
/** The shown plan is the quick one; the path is still on its way. */
export const preview = signal(false);
/** Why the service refused the question itself (not: why the terrain is infeasible). */
export const refusal = signal<string | null>(null);
/** The newest question has waited for longer than anyone would overlook. */
export const slow = signal(false);
export const waited = signal(0);

const shownKey = signal("");

interface Question {
  /** When the drawing asked, for the benchmark of dragging. */
  asked?: number;
  which: "preview" | "a" | "b";
  request: PlanRequest;
  key: string;
}

export const request = computed<PlanRequest | null>(() => {
  if (isEmpty.value || robots.value.length === 0 || !settings.value) return null;
  return ask(method.value, changedWeights.value);
});
const requestKey = computed(() => JSON.stringify(request.value));

/** The shown plan answers an older question than the one on screen. */
export const stale = computed(() => shownKey.value !== requestKey.value);

function ask(by: Method, weights: PlanRequest["weights"]): PlanRequest {
  const state = drawing.value;
  return {
    terrain: terrainDocument(state),
    robot: robotName.value,
    friction: state.friction,
    method: by,
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

/** How long the last answers took [ms]; 0 before the first. */
const took = { a: 0, preview: 0, b: 0 };
/** The path follows a preview once the hand rests for this long [ms]. */
const REST = 200;
let resting: ReturnType<typeof setTimeout> | undefined;

async function solve(question: Question, abort: AbortSignal): Promise<Plan> {
  const started = performance.now();
  const answer = await postPlan(question.request, abort);
  took[question.which] = performance.now() - started;
  return answer;
}

function show(answer: Plan, question: Question, newest: boolean): void {
  if (question.asked !== undefined) {
    const detail = question.asked;
    requestAnimationFrame(() => performance.mark("stairwright:poses", { detail }));
  }
  if (question.which === "b") {
    if (newest) planB.value = answer;
    return;
  }
  if (question.which === "preview") {
    // Where the quick method finds no way, the path may: only good news is worth showing early.
    if (answer.status === "feasible") {
      batch(() => {
        plan.value = answer;
        preview.value = true;
        shownKey.value = "";
      });
    }
    if (newest) askForPath(question);
    return;
  }
  batch(() => {
    plan.value = answer;
    preview.value = false;
    shownKey.value = question.key;
    refusal.value = null;
  });
  if (!newest) return;
  stopWaiting();
  if (compare.peek()) askForB(question);
}

function askForA(question: PlanRequest, key: string): void {
  clearTimeout(resting);
  // Only where the quick method is quick: on some terrains it is not.
  const worth = took.a > LIVE && took.preview < took.a / 2;
  if (question.method !== "path" || !worth) {
    queue.ask({ which: "a", request: question, key, asked: performance.now() });
    return;
  }
  const { weights: _, ...rest } = question;
  queue.ask({
    which: "preview",
    asked: performance.now(),
    request: { ...rest, method: "critical" },
    key,
  });
}

/** After the preview: the question that was meant. */
function askForPath(previewed: Question): void {
  clearTimeout(resting);
  resting = setTimeout(() => {
    const meant = request.peek();
    if (meant && requestKey.peek() === previewed.key) {
      queue.ask({ which: "a", request: meant, key: previewed.key });
    }
  }, REST);
}

function askForB(question: Question): void {
  const { weights: _, ...rest } = question.request;
  queue.ask({ which: "b", request: { ...rest, method: "nominal" }, key: question.key });
}

function fail(error: unknown, question: Question, newest: boolean): void {
  report(error);
  if (!newest) return;
  if (question.which === "preview" && connected.peek()) {
    askForPath(question);
    return;
  }
  if (question.which === "b") return;
  stopWaiting();
  if (connected.peek()) refusal.value = error instanceof Error ? error.message : String(error);
}

const queue = new NewestWins<Question, Plan>(solve, show, fail);

function forget(): void {
  clearTimeout(resting);
  queue.forget();
  stopWaiting();
}

/** Follow every change of drawing and set-up from now on. */
export function startPlanning(): () => void {
  const stopA = effect(() => {
    const question = request.value;
    const key = requestKey.value;
    if (!question) {
      forget();
      batch(() => {
        plan.value = null;
        planB.value = null;
        refusal.value = null;
        shownKey.value = key;
      });
      return;
    }
    if (!connected.value) return;
    if (key === shownKey.peek()) {
      // Back to what is shown already (undo, reset): what was asked meanwhile must not replace it.
      forget();
      return;
    }
    startWaiting();
    askForA(question, key);
  });
  const stopB = effect(() => {
    if (!compare.value) planB.value = null;
    else if (request.peek() && !stale.peek() && connected.value) {
      askForB({ which: "a", request: request.peek()!, key: requestKey.peek() });
    }
  });
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
