/** To the plan with the other end of the robot in front: the only one, or the safer one. */

import type { Plan } from "../api/types";
import { fixed } from "../geometry/format";
import { worst } from "../profile-editor/margins";
import { plan, stale } from "../state/planning";
import { setFacing } from "../state/setup";

export function PlanOtherEnd({ of }: { of: Plan | null | undefined }) {
  const facing = of?.problem?.feasible_facing ?? of?.safer_facing?.facing;
  if (!facing) return null;
  return (
    <button type="button" class="other-end" onClick={() => setFacing(facing)}>
      Plan {facing}
    </button>
  );
}

/** How much more margin the CoM has with the other end in front; null where that is no safer. */
export function saferEnd(shown: Plan | null): string | null {
  const safer = shown?.safer_facing;
  if (!safer) return null;
  const [now, then] = [worst(shown.poses, "com"), safer.com_margin];
  return `CoM margin ${fixed(now * 1e3, 0)} mm, ${safer.facing} ${fixed(then * 1e3, 0)} mm`;
}

/** The same with the button, under the choice of the end that leads. */
export function SaferEnd() {
  const text = saferEnd(plan.value);
  if (!text || stale.value) return null;
  return (
    <p class="effect-wait">
      {text} <PlanOtherEnd of={plan.value} />
    </p>
  );
}
