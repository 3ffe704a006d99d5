/** To the plan with the other end of the robot in front, where only that one comes through. */

import type { Problem } from "../api/types";
import { setFacing } from "../state/setup";

export function PlanOtherEnd({ stop }: { stop: Problem | null | undefined }) {
  const facing = stop?.feasible_facing;
  if (!facing) return null;
  return (
    <button type="button" class="other-end" onClick={() => setFacing(facing)}>
      Plan {facing}
    </button>
  );
}
