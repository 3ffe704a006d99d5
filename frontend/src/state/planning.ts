/** Live planning: each change asks, the newest answer shows, one solve runs at a time. */

import { computed, effect, signal } from "@preact/signals";
import { postPlan } from "../api/client";
import { NewestWins } from "../api/newest-wins";
import type { Method, Plan, PlanRequest } from "../api/types";
import { connected, report } from "./connection";
import { drawing, isEmpty, terrainDocument } from "./drawing";
import { changedWeights, compare, method, robotName, robots, settings } from "./setup";

/** Shorter waits show no spinner: it would only flicker. */
const PATIENCE = 150;

export const plan = signal<Plan | null>(null);
/** B of the comparison: the same terrain without pose optimisation. */
export const planB = signal<Plan | null>(null);
/** Why the service refused the question itself (not: why the terrain is infeasible). */
export const refusal = signal<string | null>(null);
/** The newest question has waited for longer than anyone would overlook. */
export const slow = signal(false);
export const waited = signal(0);
/** Question to answer as the page saw it [ms]: the newest ones, for the benchmark. */
export const roundTrips: number[] = [];

const shownKey = signal("");

interface Question {
  which: "a" | "b";
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

async function solve(question: Question): Promise<Plan> {
  const started = performance.now();
  const answer = await postPlan(question.request);
  roundTrips.push(performance.now() - started);
  if (roundTrips.length > 1000) roundTrips.shift();
  return answer;
}

function show(answer: Plan, question: Question, newest: boolean): void {
  if (question.which === "b") {
    if (newest) planB.value = answer;
    return;
  }
  plan.value = answer;
  shownKey.value = question.key;
  refusal.value = null;
  if (!newest) return;
  stopWaiting();
  if (compare.peek()) askForB(question);
}

function askForB(question: Question): void {
  const { weights: _, ...rest } = question.request;
  queue.ask({ which: "b", request: { ...rest, method: "nominal" }, key: question.key });
}

function fail(error: unknown, newest: boolean): void {
  report(error);
  if (!newest) return;
  stopWaiting();
  if (connected.peek()) refusal.value = error instanceof Error ? error.message : String(error);
}

const queue = new NewestWins<Question, Plan>(solve, show, fail);

/** Follow every change of drawing and set-up from now on. */
export function startPlanning(): () => void {
  const stopA = effect(() => {
    const question = request.value;
    const key = requestKey.value;
    if (!question) {
      queue.forget();
      stopWaiting();
      plan.value = null;
      planB.value = null;
      shownKey.value = key;
      return;
    }
    if (!connected.value || key === shownKey.peek()) return;
    startWaiting();
    queue.ask({ which: "a", request: question, key });
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
