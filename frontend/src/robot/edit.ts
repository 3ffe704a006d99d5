/** The robot under the hand: what was changed on it, and the way back. */

import { batch, computed, signal } from "@preact/signals";
import type { ImportedRobot, RobotDocument } from "../api/types";
import { commitChoices } from "../state/drawing";
import { stir } from "../state/planner";
import {
  asDocument,
  robotDocument,
  robotEdits,
  robotName,
  robots,
  storedRobot,
} from "../state/setup";
import { clamped, QUANTITIES, quantityOf } from "./quantities";

/** What files held that were read in this visit, by the name of their robot. */
export const imports = signal<Readonly<Record<string, ImportedRobot>>>({});
/** The quantity in hand: teal in drawing and table. */
export const selected = signal<string | null>(null);
/** Joint angles that were set by hand, only to look at. */
export const posture = signal<number[] | null>(null);

/** As it was before any change: stored, or as the file had it. */
export const base = computed<RobotDocument | null>(() => baseOf(robotName.value));

export function baseOf(name: string): RobotDocument | null {
  const stored = robots.value.find((r) => r.name === name);
  if (stored) return stored;
  const read = imports.value[name];
  return read ? asDocument(read.robot) : null;
}

/** Ids of the quantities that are not what they were. */
export const changed = computed<ReadonlySet<string>>(() => {
  const now = robotDocument.value;
  const before = base.value;
  if (!now || !before || now === before) return new Set();
  return new Set(QUANTITIES.filter((q) => q.read(now) !== q.read(before)).map((q) => q.id));
});

/** Whether there is a way back to what it was. */
export const edited = computed(
  () =>
    changed.value.size > 0 ||
    (storedRobot.value !== null && robotDocument.value !== storedRobot.value),
);

const same = (a: number | null, b: number | null) => a === b;

/** Show another state of the robot; the plan follows. No step in the history yet. */
export function draft(next: RobotDocument): void {
  const name = robotName.peek();
  const before = baseOf(name);
  const back = before && QUANTITIES.every((q) => same(q.read(next), q.read(before)));
  const { [name]: _, ...others } = robotEdits.peek();
  const keep = !(back && robots.peek().some((r) => r.name === name));
  stir();
  robotEdits.value = keep ? { ...others, [name]: back && before ? before : next } : others;
}

export function set(id: string, value: number): void {
  const now = robotDocument.peek();
  const q = quantityOf(id);
  if (now) draft(q.write(now, clamped(q, value)));
}

/** One step in the history, however many drafts led to it. */
export const finish = commitChoices;

export function resetQuantity(id: string): void {
  const before = base.peek();
  const value = before && quantityOf(id).read(before);
  if (value === null || value === undefined) return;
  set(id, value);
  finish();
}

export function resetRobot(): void {
  const name = robotName.peek();
  const before = baseOf(name);
  if (!before) return;
  const { [name]: _, ...others } = robotEdits.peek();
  const stored = robots.peek().some((r) => r.name === name);
  robotEdits.value = stored ? others : { ...others, [name]: before };
  posture.value = null;
  finish();
}

export function choose(name: string): void {
  batch(() => {
    robotName.value = name;
    posture.value = null;
    selected.value = null;
  });
}
