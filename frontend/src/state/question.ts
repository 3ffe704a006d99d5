/** What the planner is asked, from drawing and set-up. */

import { computed } from "@preact/signals";
import type { Method, PlanRequest } from "../api/types";
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

/** The question of B: the same without pose optimisation. */
export function unoptimised(question: PlanRequest): PlanRequest {
  const { weights: _, timing: __, tolerance: ___, ...rest } = question;
  return { ...rest, method: "nominal" };
}

/** The question that the quick method is asked: the same without the full method's weights. */
export function quick(question: PlanRequest): PlanRequest {
  const { weights: _, timing: __, tolerance: ___, ...rest } = question;
  return { ...rest, method: "critical" };
}

function ask(by: Method, weights: PlanRequest["weights"]): PlanRequest {
  const state = drawing.value;
  return {
    terrain: terrainDocument(state),
    robot: robotSource.value,
    friction: state.friction,
    method: by,
    ...(by === "path" && timing.value === "fast" ? { timing: "fast" as const } : {}),
    ...(facing.value === "backward" ? { facing: "backward" as const } : {}),
    ...(by === "path" && Object.keys(tolerance.value).length > 0
      ? { tolerance: tolerance.value }
      : {}),
    ...(weights && Object.keys(weights).length > 0 ? { weights } : {}),
  };
}
