/** The wheel centre's curve for drawing: the upper rim of discs rolled along the profile. */

import type { Vec2 } from "../api/types";
import type { Points } from "./profile";

/** With more corners than this the samples alone tell the curve. */
const MANY = 300;

/** Samples of the curve between two x, `step` apart and on either side of every jump. */
export function wheelPath(
  points: Points,
  radius: number,
  from: number,
  to: number,
  step: number,
): Vec2[] {
  const xs: number[] = [];
  for (let x = from; x <= to; x += step) xs.push(x);
  for (const p of points.length > MANY ? [] : points) {
    for (const side of [-radius, radius]) {
      const x = p[0] + side;
      if (x > from && x < to) xs.push(x - 1e-6, x + 1e-6);
    }
  }
  xs.sort((a, b) => a - b);
  let lo = 0;
  const path: Vec2[] = [];
  for (const x of xs) {
    while (lo + 1 < points.length && points[lo + 1]![0] < x - radius) lo++;
    let z = Number.NEGATIVE_INFINITY;
    for (let i = lo; i < points.length; i++) {
      const a = points[i]!;
      if (a[0] > x + radius) break;
      z = Math.max(z, overCorner(a, x, radius));
      const b = points[i + 1];
      if (b) z = Math.max(z, overSegment(a, b, x, radius));
    }
    if (Number.isFinite(z)) path.push([x, z]);
  }
  return path;
}

function overCorner(p: Vec2, x: number, radius: number): number {
  const dx = x - p[0];
  const square = radius * radius - dx * dx;
  return square >= 0 ? p[1] + Math.sqrt(square) : Number.NEGATIVE_INFINITY;
}

function overSegment(a: Vec2, b: Vec2, x: number, radius: number): number {
  const dx = b[0] - a[0];
  const dz = b[1] - a[1];
  const length = Math.hypot(dx, dz);
  if (dx < 1e-9) return Number.NEGATIVE_INFINITY;
  const ax = a[0] - (dz / length) * radius;
  if (x < ax || x > ax + dx) return Number.NEGATIVE_INFINITY;
  return a[1] + (dx / length) * radius + ((x - ax) * dz) / dx;
}
