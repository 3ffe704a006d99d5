/** B: another robot on the same terrain, planned after A each time. */

import { batch, computed, signal } from "@preact/signals";
import type { Plan } from "../api/types";
import { commitChoices } from "../state/drawing";
import { requestWith } from "../state/question";
import { allRobots, robotEdits, robotName, robots, sourceOf } from "../state/setup";
import { choose } from "./edit";

export const rivalName = signal("a1_wheeled");
export const rivalPlan = signal<Plan | null>(null);
export const rivalPending = signal(true);

/** Of the same name as A it is the robot as it was before it was changed. */
const source = computed(() =>
  rivalName.value === robotName.value
    ? rivalName.value
    : sourceOf(rivalName.value, robotEdits.value),
);

export const rivalRequest = computed(() =>
  robots.value.length > 0 ? requestWith(source.value) : null,
);

/** The document that B is drawn with. */
export const rivalDocument = computed(() => {
  const stored = robots.value.find((r) => r.name === rivalName.value) ?? null;
  if (rivalName.value === robotName.value) return stored;
  return robotEdits.value[rivalName.value] ?? stored;
});

/** Names that B can have: all that are stored or edited. */
export const rivals = computed(() => allRobots.value.map((r) => r.name));

export function swap(): void {
  const [a, b] = [robotName.peek(), rivalName.peek()];
  batch(() => {
    rivalName.value = a;
    choose(b);
  });
  commitChoices();
}
