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

/** How much more of a thin margin the other end in front leaves; null where that is no safer. */
export function saferEnd(shown: Plan | null): string | null {
  const safer = shown?.safer_facing;
  if (!safer) return null;
  const near = safer.by === "clearance" && safer.clearance != null;
  const [name, then] = near ? ["Clearance", safer.clearance!] : ["CoM margin", safer.com_margin];
  const now = worst(shown.poses, near ? "clearance" : "com");
  return `${name} ${fixed(now * 1e3, 0)} mm, ${safer.facing} ${fixed(then * 1e3, 0)} mm`;
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
