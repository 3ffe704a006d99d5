/** The plan on screen: of which question it is the answer, and whether a newer one is on its way. */

import { computed, effect, signal } from "@preact/signals";
import type { Plan } from "../api/types";
import type { RobotShape } from "../geometry/robot";
import { connected } from "./connection";
import { requestKey } from "./question";
import { robotFacing } from "./setup";
import { slow } from "./waiting";

export const plan = signal<Plan | null>(null);
/** B of the comparison: the same terrain without pose optimisation. */
export const planB = signal<Plan | null>(null);
/**
 * The paper's poses for what is drawn now, while `plan` still answers an older question: they
 * follow the hand, and all that only a full path can tell keeps still until it comes. Or, with a
 * problem and without poses, that there is no path for it; what would open one is looked for.
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
/** The question that `plan` answers, as text. */
export const shownKey = signal("");

/** The robot as a plan has it: the end that leads is its front. */
export const robotOf = (shown: Plan | null): RobotShape | null =>
  robotFacing.value?.[shown?.facing ?? "forward"] ?? null;
/** As the shown plan has it. */
export const robot = computed(() => robotOf(plan.value));

/** The shown plan answers an older question than the one on screen. */
export const stale = computed(() => shownKey.value !== requestKey.value);
/** It does so for longer than anyone would overlook: with a slow answer, or none for now. */
export const outdated = computed(() =>
  connected.value ? slow.value && !preview.value : stale.value,
);

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
