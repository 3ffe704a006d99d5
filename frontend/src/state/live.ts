/** What a running rollout has sent of itself so far. */

import { signal } from "@preact/signals";
import type { Drive, Plan, Series } from "../api/types";

/** The drive up to now; null while none runs or it has not said anything yet. */
export const live = signal<Drive | null>(null);
/** The plan that is being driven. */
export const livePlan = signal<Plan | null>(null);

/** A stretch of the series, the first of its samples being number `from`. */
export type Chunk = Pick<Series, Tracked> & { from: number };

const TRACKED = [
  "time",
  "pitch",
  "pitch_desired",
  "progress",
  "q",
  "q_desired",
  "base_position",
  "base_quaternion",
] as const;
type Tracked = (typeof TRACKED)[number];

export function startLive(plan: Plan): void {
  livePlan.value = plan;
  live.value = null;
}

/** Append a stretch. One that begins beyond what is known cannot be placed and is left out. */
export function grow({ from, ...chunk }: Chunk): void {
  const before = live.peek()?.series;
  const known = before?.time.length ?? 0;
  if (from > known || chunk.time.length === 0) return;
  const joined = TRACKED.map((name) => [
    name,
    [...((before?.[name] as unknown[]) ?? []).slice(0, from), ...chunk[name]],
  ]);
  live.value = { outcome: "running", series: Object.fromEntries(joined) as Series };
}

/** The run was given up: what was driven stays, and says so. */
export function haltLive(): void {
  if (live.peek()) live.value = { ...live.peek()!, outcome: "cancelled" };
  else livePlan.value = null;
}

export function endLive(): void {
  live.value = null;
  livePlan.value = null;
}
