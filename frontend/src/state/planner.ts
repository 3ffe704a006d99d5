/**
 * Live planning: each change asks, the newest answer shows, one solve runs at a time. Where the
 * full path takes longer than a hand waits, the paper's few poses come first and the path follows;
 * where they find no way, it is first asked whether there is a path, and then what would open it.
 */

import { batch, computed, effect, type ReadonlySignal, type Signal, signal } from "@preact/signals";
import { postPlan, reasonOf } from "../api/client";
import { connectLive, livePlan } from "../api/live";
import { NewestWins } from "../api/newest-wins";
import type { Plan, PlanRequest } from "../api/types";
import { connected, report } from "./connection";
import { Pace } from "./pace";
import { answered, plan, planB, preview, refusal, shownKey, stale } from "./planning";
import { request, requestKey, simpler } from "./question";
import { compare } from "./setup";
import { startWaiting, stopWaiting } from "./waiting";

/** The path follows a preview once the hand has rested for this long [ms]. */
const REST = 100;
/** A path that has run for this long gives way to a newer question in any case [ms]. */
const LONGEST = 400;

interface Question {
  /** When the drawing asked [ms]. */
  asked: number;
  which: "preview" | "verdict" | "a" | "b";
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
  const brief = question.which === "preview" || question.which === "verdict";
  const answer = await (method === "critical" || brief
    ? livePlan(question.request, !brief, abort)
    : postPlan(question.request, abort));
  const trip = performance.now() - started;
  if (method !== "nominal" && question.which !== "verdict") {
    pace.measured(method === "path" ? "full" : "quick", trip, answer);
  }
  return answer;
}

/** A path gives way to newer poses, unless those have been no help: then it is all there is. */
function yields(running: Question, next: Question, since: number): boolean {
  if (running.which === "b") return next.which !== "b";
  if (running.which === "preview" || next.which !== "preview") return false;
  return pace.finds || since > LONGEST;
}

function show(answer: Plan, question: Question, newest: boolean): void {
  if (question.follower) {
    answerFollower(question.follower, question.key, answer);
    return;
  }
  markDrawn(question.asked);
  if (question.which === "preview") showPreview(answer, question, newest);
  else if (question.which === "verdict") showVerdict(answer, question, newest);
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

/** That there is no path is shown at once; what stops the robot follows. */
function showVerdict(answer: Plan, question: Question, newest: boolean): void {
  preview.value = answer.problem ? answer : null;
  if (!newest) return;
  if (answer.problem) stopWaiting();
  queue.ask({ ...question, which: "a" });
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

function askForA(request: PlanRequest, key: string): void {
  clearTimeout(resting);
  const asked = performance.now();
  if (request.method === "path" && pace.worthPreview) {
    const easier = simpler(request, "critical", plan.peek());
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
  const which = pace.finds ? "a" : "verdict";
  queue.ask({ which, request: meant, key: before.key, asked: before.asked });
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
    refusal.value = reasonOf(error);
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
    compare.value && request.value ? simpler(request.value, "nominal", plan.value) : null,
  );
  const stopB = follow(nominal, planB);
  return () => {
    stopA();
    stopB();
  };
}
