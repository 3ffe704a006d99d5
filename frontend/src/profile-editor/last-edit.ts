/** What the last edit made of a face, in a sentence. */

import { fixed } from "../geometry/format";
import { drawing, previous } from "../state/drawing";

const face = (dz: number) => (dz < 0 ? "drop" : "riser");
const high = (dz: number) => `${fixed(Math.abs(dz), 3)} m`;

function sentence(old: number, now: number): string {
  const [was, is] = [face(old), face(now)];
  if (Math.abs(old) < 1e-4) return `This edit made a ${is} of ${high(now)}.`;
  if (was !== is) return `This edit turned a ${was} of ${high(old)} into a ${is} of ${high(now)}.`;
  const more = Math.abs(now) > Math.abs(old);
  const verb = is === "riser" ? (more ? "raised" : "lowered") : more ? "deepened" : "reduced";
  return `This edit ${verb} the ${is} from ${fixed(Math.abs(old), 3)} to ${high(now)}.`;
}

/** Null where it made no upright face higher or lower. */
export function lastEdit(): string | null {
  const before = previous.value?.points;
  const after = drawing.value.points;
  if (!before || before.length !== after.length) return null;
  for (let i = 0; i + 1 < after.length; i++) {
    const upright = Math.abs(after[i + 1]![0] - after[i]![0]) < 1e-6;
    const old = before[i + 1]![1] - before[i]![1];
    const now = after[i + 1]![1] - after[i]![1];
    if (upright && Math.abs(now - old) > 1e-4) return sentence(old, now);
  }
  return null;
}
