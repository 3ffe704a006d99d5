/** The robot at a time: between the poses of a plan or the samples of a rollout. */

import type { Drive, Plan } from "../api/types";
import type { Frame } from "./robot";

/** Index of the last entry that is not above `value`. */
export function lowerIndex(sorted: ArrayLike<number>, value: number): number {
  let low = 0;
  let high = sorted.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (sorted[middle]! <= value) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** Where `value` lies between samples: index and fraction of the way to the next. */
export function locate(sorted: ArrayLike<number>, value: number): [number, number] {
  const i = lowerIndex(sorted, value);
  const a = sorted[i] ?? 0;
  const b = sorted[i + 1];
  if (b === undefined || b <= a) return [i, 0];
  return [i, Math.min(1, Math.max(0, (value - a) / (b - a)))];
}

export function interpolate(
  times: ArrayLike<number>,
  values: ArrayLike<number>,
  t: number,
): number {
  const [i, f] = locate(times, t);
  const a = values[i] ?? Number.NaN;
  return f === 0 ? a : a + (values[i + 1]! - a) * f;
}

/** How much later than planned a rollout was at the place where it ended [s]. */
export function delay(plan: Plan, { series }: Drive): number {
  const n = series.time.length;
  if (n === 0) return 0;
  const along = plan.poses.map((pose) => pose.progress);
  return series.time[n - 1]! - interpolate(along, poseTimes(plan), series.progress[n - 1]!);
}

const mix = (a: number, b: number, f: number) => a + (b - a) * f;

const planTimesCache = new WeakMap<Plan, number[]>();

/** Planned time of each pose [s]; spread evenly over the total where a planner gives none. */
export function poseTimes(plan: Plan): number[] {
  let times = planTimesCache.get(plan);
  if (!times) {
    const last = plan.poses[plan.poses.length - 1];
    const known = last?.time !== undefined && last.time > 0;
    const scale = last && last.progress > 0 ? plan.timing.total / last.progress : 0;
    times = plan.poses.map((p) => (known ? (p.time ?? 0) : p.progress * scale));
    planTimesCache.set(plan, times);
  }
  return times;
}

export function planFrame(plan: Plan, t: number): Frame | null {
  const [i, f] = locate(poseTimes(plan), t);
  const a = plan.poses[i];
  if (!a) return null;
  const b = plan.poses[i + 1] ?? a;
  return {
    x: mix(a.x_c, b.x_c, f),
    z: mix(a.z_c, b.z_c, f),
    pitch: mix(a.pitch, b.pitch, f),
    q: a.q.map((value, k) => mix(value, b.q[k]!, f)),
  };
}

/** Left and right legs averaged into the plane. Columns: FL, FR, RL, RR, each thigh, calf, wheel. */
export function planar(q: readonly number[]): number[] {
  return [0, 1, 6, 7].map((k) => (q[k]! + q[k + 3]!) / 2);
}

export function runFrame(run: Drive, t: number): Frame | null {
  const s = run.series;
  const [i, f] = locate(s.time, t);
  const a = s.base_position[i];
  if (!a) return null;
  const j = Math.min(i + 1, s.time.length - 1);
  const b = s.base_position[j]!;
  const qa = planar(s.q[i]!);
  const qb = planar(s.q[j]!);
  return {
    x: mix(a[0]!, b[0]!, f),
    z: mix(a[2]!, b[2]!, f),
    pitch: mix(s.pitch[i]!, s.pitch[j]!, f),
    q: qa.map((value, k) => mix(value, qb[k]!, f)),
  };
}
