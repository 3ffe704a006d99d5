/** What screen readers hear: politely after a rest; at once only a fall or a lost service. */

import { effect, signal } from "@preact/signals";
import { fixed } from "../geometry/format";
import { connected } from "./connection";
import { plan, stale } from "./planning";
import { activity, run } from "./rollouts";

export const polite = signal("");
export const assertive = signal("");

const REST = 600;

function planSentence(): string {
  const shown = plan.peek();
  if (!shown || stale.peek()) return "";
  if (shown.problem) return `Infeasible. ${shown.problem.message}`;
  const motion = shown.certificate?.motion;
  if (motion) return `Feasible poses. ${motion.message}`;
  const clearance = Math.min(...shown.poses.map((p) => p.margins.clearance));
  return `Feasible, smallest clearance ${fixed(clearance * 1000, 0)} mm`;
}

export function startAnnouncing(): void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  effect(() => {
    if (!plan.value || stale.value) return;
    clearTimeout(timer);
    timer = setTimeout(() => {
      polite.value = planSentence();
    }, REST);
  });
  effect(() => {
    const done = run.value;
    if (!done || activity.value !== "idle") return;
    const sentence = `Rollout: ${done.outcome} after ${fixed(done.metrics.duration, 1)} s`;
    if (done.outcome === "success") polite.value = sentence;
    else assertive.value = sentence;
  });
  effect(() => {
    if (!connected.value) assertive.value = "Connection to the planner lost. Editing goes on.";
    else if (assertive.peek().startsWith("Connection")) {
      assertive.value = "";
      polite.value = "Connected again";
    }
  });
}
