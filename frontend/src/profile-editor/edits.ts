/** Each tool as a pure function: points and a gesture in, new points out. */

import type { Vec2 } from "../api/types";
import { heightAt, type Points } from "../geometry/profile";
import type { Stair } from "./codes";

const TINY = 1e-9;

export const round4 = (v: number) => Math.round(v * 1e4) / 1e4;
const tidy = (p: Vec2): Vec2 => [round4(p[0]), round4(p[1])];

/** An empty canvas becomes flat ground with room for the robot on either side. */
export function ground(points: Points, x: number): Points {
  if (points.length >= 2) return points;
  return [
    [round4(x - 1.5), 0],
    [round4(x + 2), 0],
  ];
}

/** Split the profile at x: corners up to there, its height, corners after. */
function cut(points: Points, x: number): { before: Vec2[]; z: number; after: Vec2[] } {
  const z = heightAt(points, x);
  const last = points.findLastIndex((p) => p[0] <= x + TINY);
  return {
    before: points.slice(0, last + 1) as Vec2[],
    z,
    after: points.slice(last + 1) as Vec2[],
  };
}

function join(parts: Vec2[]): Vec2[] {
  const out: Vec2[] = [];
  for (const p of parts.map(tidy)) {
    const end = out[out.length - 1];
    if (!end || end[0] !== p[0] || end[1] !== p[1]) out.push(p);
  }
  return withoutStraight(out);
}

/** Drop corners in the middle of a straight run. */
function withoutStraight(points: Vec2[]): Vec2[] {
  return points.filter((p, i) => {
    const a = points[i - 1];
    const b = points[i + 1];
    if (!a || !b) return true;
    const cross = (p[0] - a[0]) * (b[1] - p[1]) - (p[1] - a[1]) * (b[0] - p[0]);
    const ahead = (p[0] - a[0]) * (b[0] - p[0]) + (p[1] - a[1]) * (b[1] - p[1]);
    return Math.abs(cross) > TINY || ahead < 0;
  });
}

/** Keep x within the points' reach, so that a flat stretch stays on either side. */
function clampX(points: Points, x: number): number {
  const first = points[0]![0];
  const last = points[points.length - 1]![0];
  return round4(Math.min(last - 0.05, Math.max(first + 0.05, x)));
}

const moved = (points: Vec2[], dx: number, dz: number) =>
  points.map((p): Vec2 => [p[0] + dx, p[1] + dz]);

/** `count` steps from x on; everything after them moves along. */
export function addStairs(points: Points, at: number, stair: Stair, count: number): Vec2[] {
  const base = ground(points, at);
  const x = clampX(base, at);
  const { before, z, after } = cut(base, x);
  const steps: Vec2[] = [[x, z]];
  for (let i = 0; i < count; i++) {
    steps.push([x + i * stair.run, z + (i + 1) * stair.rise]);
    if (i < count - 1) steps.push([x + (i + 1) * stair.run, z + (i + 1) * stair.rise]);
  }
  return join([...before, ...steps, ...moved(after, (count - 1) * stair.run, count * stair.rise)]);
}

/** A ramp from x that gains `rise` over `run`; everything after it moves along. */
export function addRamp(points: Points, at: number, run: number, rise: number): Vec2[] {
  const base = ground(points, at);
  const x = clampX(base, at);
  const { before, z, after } = cut(base, x);
  const length = Math.max(0.01, run);
  const ramp: Vec2[] = [
    [x, z],
    [x + length, z + rise],
  ];
  return join([...before, ...ramp, ...moved(after, length, rise)]);
}

/** Level ground between two x; what follows keeps its place and joins with a face. */
export function addFlat(points: Points, from: number, to: number): Vec2[] {
  const base = ground(points, from);
  const a = clampX(base, Math.min(from, to));
  const b = clampX(base, Math.max(from, to));
  if (b - a < 0.005) return base as Vec2[];
  const { before, z } = cut(base, a);
  const { after, z: end } = cut(base, b);
  const level: Vec2[] = [
    [a, z],
    [b, z],
    [b, end],
  ];
  return join([...before, ...level, ...after]);
}

/** Level ground for a robot to stand on before and after a drawn line [m]. */
const STAND = 1;

/**
 * A drawn line replaces the ground below it; what follows rises or sinks to its end. Where it
 * leads beyond the ground, or there is none yet, the ground grows with it.
 */
export function addFree(
  points: Points,
  stroke: readonly Vec2[],
  tolerance: number,
  upright = 0,
): Vec2[] {
  const line = plumb(simplify(fromLeft(stroke).map(tidy), tolerance), upright);
  const [a, b] = [line[0], line[line.length - 1]];
  if (!a || !b || a === b) return points as Vec2[];
  const base = points.length >= 2 ? points : line;
  const [first, last] = [base[0]!, base[base.length - 1]!];
  const { before, z } = cut(base, a[0]);
  const { after, z: under } = cut(base, b[0]);
  const begin: Vec2[] =
    a[0] < first[0]
      ? [[a[0] - STAND, a[1]]]
      : [[Math.min(first[0], a[0] - STAND), first[1]], ...before, [a[0], z]];
  const end: Vec2 = [Math.max(last[0], b[0] + STAND), last[1]];
  return join([...begin, ...line, ...moved([...after, end], 0, b[1] - under)]);
}

/** The stroke from left to right, whichever way it was drawn, without where it turns back. */
function fromLeft(stroke: readonly Vec2[]): Vec2[] {
  const way = (stroke[stroke.length - 1]?.[0] ?? 0) < (stroke[0]?.[0] ?? 0) ? -1 : 1;
  const line: Vec2[] = [];
  for (const p of stroke) {
    const end = line[line.length - 1];
    const on = end ? way * (p[0] - end[0]) : 1;
    if (on > 0 || (on === 0 && p[1] !== end![1])) line.push(p);
  }
  return way < 0 ? line.reverse() : line;
}

/** Steeper than this, a drawn stretch is meant to be a riser (60 degrees). */
const RISER = 1.7;

/** Stretches that are nearly upright become so: no corner moves further than `within`. */
export function plumb(line: readonly Vec2[], within: number): Vec2[] {
  const out = line.map((p): Vec2 => [p[0], p[1]]);
  for (let i = 1; i < out.length; i++) {
    const [a, b] = [out[i - 1]!, out[i]!];
    const run = b[0] - a[0];
    // The last corner of a line holds its end; all others give way to the one before.
    if (run > 0 && run <= within && Math.abs(b[1] - a[1]) > RISER * run) b[0] = a[0];
  }
  return out;
}

/** Ramer-Douglas-Peucker: the fewest corners within `tolerance` of the line. */
export function simplify(line: readonly Vec2[], tolerance: number): Vec2[] {
  if (line.length < 3) return [...line];
  const a = line[0]!;
  const b = line[line.length - 1]!;
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
  let worst = 0;
  let at = 0;
  for (let i = 1; i < line.length - 1; i++) {
    const p = line[i]!;
    const off = Math.abs((p[0] - a[0]) * (b[1] - a[1]) - (p[1] - a[1]) * (b[0] - a[0])) / length;
    if (off > worst) {
      worst = off;
      at = i;
    }
  }
  if (worst <= tolerance) return [a, b];
  return [
    ...simplify(line.slice(0, at + 1), tolerance).slice(0, -1),
    ...simplify(line.slice(at), tolerance),
  ];
}

/** A vertex in the middle of segment `i`, or at x where one is given. */
export function addVertex(
  points: Points,
  i: number,
  x?: number,
): { points: Vec2[]; index: number } {
  const a = points[i]!;
  const b = points[i + 1]!;
  const f = x === undefined || b[0] - a[0] < TINY ? 0.5 : (x - a[0]) / (b[0] - a[0]);
  const p = between(a, tidy([a[0] + (b[0] - a[0]) * f, a[1] + (b[1] - a[1]) * f]), b);
  return { points: [...points.slice(0, i + 1), p, ...points.slice(i + 1)] as Vec2[], index: i + 1 };
}

export function removeVertices(points: Points, which: readonly number[]): Vec2[] {
  const left = points.filter((_, i) => !which.includes(i)) as Vec2[];
  return left.length >= 2 ? left : [];
}

/**
 * Move vertices together; x stops at the neighbours that stay. With `rest`, all later ones follow.
 */
export function moveVertices(
  points: Points,
  which: readonly number[],
  dx: number,
  dz: number,
  rest = false,
): Vec2[] {
  const chosen = new Set(which);
  if (rest) for (let i = Math.min(...which); i < points.length; i++) chosen.add(i);
  let least = Number.NEGATIVE_INFINITY;
  let most = Number.POSITIVE_INFINITY;
  for (const i of chosen) {
    const before = points[i - 1];
    const after = points[i + 1];
    if (before && !chosen.has(i - 1)) least = Math.max(least, before[0] - points[i]![0]);
    if (after && !chosen.has(i + 1)) most = Math.min(most, after[0] - points[i]![0]);
  }
  const x = Math.min(most, Math.max(least, dx));
  return points.map((p, i): Vec2 => {
    if (!chosen.has(i)) return [p[0], p[1]];
    const before = chosen.has(i - 1) ? undefined : points[i - 1];
    const after = chosen.has(i + 1) ? undefined : points[i + 1];
    return between(before, tidy([p[0] + x, p[1] + dz]), after);
  });
}

/** Rounding must not carry a corner past a neighbour that has more digits. */
function between(before: Vec2 | undefined, p: Vec2, after: Vec2 | undefined): Vec2 {
  const least = before?.[0] ?? Number.NEGATIVE_INFINITY;
  const most = after?.[0] ?? Number.POSITIVE_INFINITY;
  return [Math.min(most, Math.max(least, p[0])), p[1]];
}

/** Set the run or the rise of segment `i`; everything after it moves along. */
export function setDimension(
  points: Points,
  i: number,
  which: "run" | "rise",
  value: number,
): Vec2[] {
  const a = points[i]!;
  const b = points[i + 1]!;
  const dx = which === "run" ? Math.max(0, value) - (b[0] - a[0]) : 0;
  const dz = which === "rise" ? value - (b[1] - a[1]) : 0;
  return points.map((p, k): Vec2 => {
    const moved = k > i ? tidy([p[0] + dx, p[1] + dz]) : ([p[0], p[1]] as Vec2);
    return k === i + 1 ? between(a, moved, undefined) : moved;
  });
}
