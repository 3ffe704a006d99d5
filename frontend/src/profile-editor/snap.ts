/** Where a dragged corner comes to rest: neighbours, stairs by the code, the grid. */

import { signal } from "@preact/signals";
import type { Vec2 } from "../api/types";
import type { Points } from "../geometry/profile";
import type { StairCode } from "./codes";

/** Grid spacing [m]; 0 is off. */
export const grid = signal(0.005);
export const toNeighbours = signal(true);
/** Rise and run that steps snap to; null for none. */
export const code = signal<StairCode | null>(null);

/** What is drawn this far from upright becomes upright [m]; 0 is off. */
export const riserTolerance = signal(0.02);
export const TOLERANCES = [0, 0.01, 0.02, 0.05];

export const GRIDS = [0, 0.001, 0.005, 0.01, 0.05];

/** No hand draws a riser straighter than this [px]. */
const SHAKE = 6;

/** How far from upright a line drawn by hand may be, at `scale` pixels per metre [m]. */
export const uprightWithin = (scale: number) =>
  riserTolerance.peek() && Math.max(riserTolerance.peek(), SHAKE / scale);

/** Nearer than this on screen, a neighbour's x or z attracts [px]. */
const REACH = 6;

export interface Snapped {
  at: Vec2;
  /** Corners whose x or z was taken, for the guide lines. */
  x: Vec2 | null;
  z: Vec2 | null;
}

export function onGrid(value: number): number {
  const step = grid.peek();
  return step ? Math.round(value / step) * step : value;
}

/** Snap a place for corner `moving` (or a new one, -1) at `scale` pixels per metre. */
export function snap(
  points: Points,
  moving: number,
  at: Vec2,
  scale: number,
  free: boolean,
): Snapped {
  if (free) return { at, x: null, z: null };
  const reach = REACH / scale;
  const result: Snapped = { at: [onGrid(at[0]), onGrid(at[1])], x: null, z: null };
  const before = points[moving - 1];
  const stair = code.peek();
  if (stair && before) {
    for (const rise of [stair.rise, -stair.rise]) {
      if (Math.abs(before[1] + rise - at[1]) < 2.5 * reach) result.at[1] = before[1] + rise;
    }
    if (Math.abs(before[0] + stair.run - at[0]) < 2.5 * reach) result.at[0] = before[0] + stair.run;
  }
  if (!toNeighbours.peek()) return result;
  const near = nearest(points, moving, at, reach);
  if (near.x) {
    result.at[0] = near.x[0];
    result.x = near.x;
  }
  if (near.z) {
    result.at[1] = near.z[1];
    result.z = near.z;
  }
  return result;
}

function nearest(points: Points, moving: number, at: Vec2, reach: number) {
  let x: Vec2 | null = null;
  let z: Vec2 | null = null;
  let [dx, dz] = [reach, reach];
  points.forEach((p, i) => {
    if (i === moving) return;
    const offX = Math.abs(p[0] - at[0]);
    const offZ = Math.abs(p[1] - at[1]);
    if (offX < dx) [dx, x] = [offX, p];
    if (offZ < dz) [dz, z] = [offZ, p];
  });
  return { x: x as Vec2 | null, z: z as Vec2 | null };
}
