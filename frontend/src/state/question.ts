/** What the planner is asked, from drawing and set-up. */

import { computed } from "@preact/signals";
import type { Method, Plan, PlanRequest } from "../api/types";
import { drawing, isEmpty, terrainDocument } from "./drawing";
import {
  changedWeights,
  facing,
  method,
  robotSource,
  robots,
  settings,
  timing,
  tolerance,
  usualFacing,
} from "./setup";

export const request = computed<PlanRequest | null>(() => {
  if (isEmpty.value || robots.value.length === 0 || !settings.value) return null;
  return ask(method.value, changedWeights.value);
});
/** The question as text: two that read the same are the same. */
export const requestKey = computed(() => JSON.stringify(request.value));

/** What another robot would be asked on the same terrain. */
export const requestWith = (robot: PlanRequest["robot"]): PlanRequest | null =>
  request.value && { ...request.value, robot };

/**
 * The same question to a simpler method: B's, without pose optimisation, or the quick one of a few
 * poses. Weights, timing and tolerance are the full method's.
 * @param beside where the planner chooses which end leads, it is the one of this plan
 */
export function simpler(
  question: PlanRequest,
  by: "nominal" | "critical",
  beside: Plan | null,
): PlanRequest {
  const { weights: _, timing, tolerance: __, facing: said, ...rest } = question;
  const asked = said ?? usualFacing(timing);
  const leads = asked === "either" ? beside?.facing : asked;
  return { ...rest, method: by, ...(leads === "backward" ? { facing: leads } : {}) };
}

function ask(by: Method, weights: PlanRequest["weights"]): PlanRequest {
  const state = drawing.value;
  const fast = by === "path" && timing.value === "fast" ? ("fast" as const) : undefined;
  return {
    terrain: terrainDocument(state),
    robot: robotSource.value,
    friction: state.friction,
    method: by,
    ...(fast ? { timing: fast } : {}),
    ...(facing.value === usualFacing(fast) ? {} : { facing: facing.value }),
    ...(by === "path" && Object.keys(tolerance.value).length > 0
      ? { tolerance: tolerance.value }
      : {}),
    ...(weights && Object.keys(weights).length > 0 ? { weights } : {}),
  };
}
