/**
 * Plans while a hand drags: one connection spares each question the way through HTTP, which takes
 * longer than many an answer. Where there is no such connection, REST answers.
 */

import { ApiError, BASE, Offline, postPlan } from "./client";
import type { Plan, PlanRequest, ProblemDetail } from "./types";

interface Answer {
  id: number | null;
  status: number;
  plan?: Plan;
  problem?: ProblemDetail;
}

interface Waiting {
  id: number;
  resolve: (plan: Plan) => void;
  reject: (reason: unknown) => void;
}

/** Least time between two attempts to connect [ms]. */
const RETRY = 3000;

let socket: WebSocket | null = null;
let waiting: Waiting | null = null;
let tried = Number.NEGATIVE_INFINITY;
let count = 0;

/** Connect, if it is time to try; nothing waits for it. */
export function connectLive(): void {
  if (socket || performance.now() < tried + RETRY) return;
  tried = performance.now();
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  const fresh = new WebSocket(`${scheme}://${location.host}${BASE}/plans/live`);
  fresh.addEventListener("message", (event) => take(JSON.parse(event.data as string) as Answer));
  fresh.addEventListener("close", () => {
    socket = null;
    settle()?.reject(new Offline("The service does not answer."));
  });
  socket = fresh;
}

/**
 * The plan; a newer question takes the place of one that is not answered yet. What is not to be
 * kept comes sooner, but the service does not know it by its id.
 */
export function livePlan(request: PlanRequest, keep: boolean, abort: AbortSignal): Promise<Plan> {
  connectLive();
  const open = socket;
  if (open?.readyState !== WebSocket.OPEN) return postPlan(request, abort);
  return new Promise((resolve, reject) => {
    const id = ++count;
    settle()?.reject(new DOMException("a newer question was asked", "AbortError"));
    waiting = { id, resolve, reject };
    abort.addEventListener("abort", () => {
      if (waiting?.id !== id) return;
      settle()?.reject(abort.reason);
      if (open.readyState === WebSocket.OPEN) open.send(JSON.stringify({ id }));
    });
    open.send(JSON.stringify({ id, keep, body: request }));
  });
}

function take(answer: Answer): void {
  if (!waiting || (answer.id !== null && answer.id !== waiting.id)) return;
  const asked = settle();
  if (answer.plan) asked?.resolve(answer.plan);
  else asked?.reject(new ApiError(answer.status, answer.problem ?? {}));
}

function settle(): Waiting | null {
  const asked = waiting;
  waiting = null;
  return asked;
}
