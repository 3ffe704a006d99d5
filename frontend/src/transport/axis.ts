/** What the timeline's margin rows run along: the clock, or the ground. */

import { computed } from "@preact/signals";
import type { Drive, Plan } from "../api/types";
import { interpolate, poseTimes } from "../geometry/frames";
import { extent } from "../geometry/profile";
import { kept } from "../state/kept";
import { plan } from "../state/planning";
import { frame, plannedEnd, shownRun, shownTime } from "../state/playback";

export type AxisKind = "time" | "place";

export const axisKind = kept<AxisKind>("axis", "time", (text) =>
  text === "time" || text === "place" ? text : null,
);

/** Ends of the axis [s] or [m]. */
export const ends = computed<[number, number]>(() => {
  if (axisKind.value === "time") return [0, plannedEnd.value];
  const shown = plan.value;
  const first = shown?.poses[0];
  if (!shown || !first) return [0, 0];
  const reached = shown.poses[shown.poses.length - 1]!.x_c;
  // Beyond where a plan stops there is terrain that it does not reach.
  return [first.x_c, shown.problem ? Math.max(reached, farEnd(shown)) : reached];
});

/** A little past the last corner that is not on the ground's open end [m]. */
function farEnd(shown: Plan): number {
  const { points } = shown.terrain;
  const all = extent(points).x;
  const inner = points.length > 2 ? extent(points.slice(1, -1)).x : all;
  return Math.min(all[1], inner[1] + 0.4);
}

/** From a place on the axis to its share of the axis's length. */
export function shareOf(value: number): number {
  const [from, to] = ends.value;
  return to > from ? Math.min(1, Math.max(0, (value - from) / (to - from))) : 0;
}

/** When a robot was first as far as each pose of its plan [s]; NaN where it never was. */
export function reachedAt(shown: Plan, run: Drive): number[] {
  const { time, progress } = run.series;
  const end = run.outcome === "success" ? (time[time.length - 1] ?? 0) : Number.NaN;
  let i = 0;
  return shown.poses.map((pose) => {
    while (i < progress.length && progress[i]! < pose.progress - 1e-3) i++;
    return time[i] ?? end;
  });
}

/** When the poses of the plan are reached: by the robot where a rollout is shown [s]. */
export const passes = computed<number[]>(() => {
  const shown = plan.value;
  if (!shown) return [];
  return shownRun.value ? reachedAt(shown, shownRun.value) : poseTimes(shown);
});

/** Where the poses of the plan are on the axis; NaN where they were not reached in time. */
export const marks = computed<number[]>(() =>
  axisKind.value === "time" ? passes.value : (plan.value?.poses.map((p) => p.x_c) ?? []),
);

/** Where a time is on the axis: itself, or where the trunk is then. */
export function shareOfTime(t: number): number {
  if (axisKind.value === "time") return shareOf(t);
  const known = passes.value.findIndex((at) => Number.isNaN(at));
  const count = known < 0 ? passes.value.length : known;
  const xs = plan.value?.poses.slice(0, count).map((p) => p.x_c) ?? [];
  return shareOf(interpolate(passes.value.slice(0, count), xs, t));
}

export const cursor = computed(() => {
  if (axisKind.value === "time") return shareOf(shownTime.value);
  return frame.value ? shareOf(frame.value.x) : 0;
});

/** The time that a share of the axis stands for [s]; of a place, when what was nearest to it was reached. */
export function timeAt(share: number): number {
  const [from, to] = ends.peek();
  const at = from + Math.min(1, Math.max(0, share)) * (to - from);
  if (axisKind.peek() === "time") return at;
  const times = passes.peek();
  let best = 0;
  let least = Number.POSITIVE_INFINITY;
  plan.peek()?.poses.forEach((pose, i) => {
    const off = Math.abs(pose.x_c - at);
    if (off >= least || Number.isNaN(times[i])) return;
    [best, least] = [i, off];
  });
  return times[best] || 0;
}

/** Steps that people count in, wide enough apart for about eight of them. */
export const ticks = computed<number[]>(() => {
  const [from, to] = ends.value;
  if (!(to > from)) return [];
  const wish = (to - from) / 8;
  const power = 10 ** Math.floor(Math.log10(wish));
  const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= wish) ?? wish;
  const out: number[] = [];
  for (let k = Math.ceil(from / step); k * step <= to + 1e-9; k++) out.push(k * step);
  return out;
});
