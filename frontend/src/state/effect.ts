/** The plan with default weights beside the one with changed weights: what the weights bring. */

import { computed, effect, signal } from "@preact/signals";
import { postPlan } from "../api/client";
import type { Plan, PlanRequest } from "../api/types";
import { report } from "./connection";
import { kept, readFlag } from "./kept";
import { plan, stale } from "./planning";
import { request } from "./question";
import { changedWeights } from "./setup";

/** A slider at rest [ms]. */
const REST = 250;

const answer = signal<{ key: string; plan: Plan } | null>(null);
/** Whether the default path is drawn on the profile. */
export const ghostShown = kept("ghost", true, readFlag);

/** The same question without changed weights; null where there are none. */
const question = computed<PlanRequest | null>(() => {
  const asked = request.value;
  if (!asked || Object.keys(changedWeights.value).length === 0) return null;
  const { weights: _, ...rest } = asked;
  return rest;
});
const key = computed(() => JSON.stringify(question.value));

/** The default's plan for what is drawn now; null until it is there, or without changes. */
export const defaultPlan = computed<Plan | null>(() =>
  question.value && answer.value?.key === key.value ? answer.value.plan : null,
);

/** The default's plan where it is drawn. */
export const ghost = computed(() => (ghostShown.value ? defaultPlan.value : null));

/** After the plan that was meant has come and the hand rests, ask for the default too. */
export function startEffect(): void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  let under: AbortController | undefined;
  effect(() => {
    const text = key.value;
    clearTimeout(timer);
    under?.abort();
    if (!question.value || stale.value || !plan.value || answer.peek()?.key === text) return;
    timer = setTimeout(async () => {
      const abort = new AbortController();
      under = abort;
      try {
        const found = await postPlan(question.peek()!, abort.signal);
        if (!abort.signal.aborted) answer.value = { key: text, plan: found };
      } catch (error) {
        if (!abort.signal.aborted) report(error);
      }
    }, REST);
  });
}
