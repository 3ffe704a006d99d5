/** Where something may float over the canvas: near a spot, and on nothing that a hand must reach. */

import type { Vec2 } from "../api/types";
import { drawing } from "../state/drawing";
import { canvasBox, projection } from "./viewport";

export interface Size {
  width: number;
  height: number;
}

export interface Rect extends Size {
  left: number;
  top: number;
}

/** A fingertip beside the middle of a corner still takes hold of it [px]. */
const GRIP = 12;
/** From the canvas's rim, and from the dimensions along its lower one [px]. */
const RIM = 8;
const DIMENSIONS = 40;

/** `wide` and `tall` to either side of its middle. */
export const around = ([x, y]: Vec2, wide: number, tall = wide): Rect => ({
  left: x - wide,
  top: y - tall,
  width: 2 * wide,
  height: 2 * tall,
});

export const overlap = (a: Rect, b: Rect) =>
  a.left < b.left + b.width &&
  b.left < a.left + a.width &&
  a.top < b.top + b.height &&
  b.top < a.top + a.height;

/** Beside the spot, below it first, where the ground is; else in a corner of the canvas. */
function places([x, y]: Vec2, { width, height }: Size, gap: Vec2): Rect[] {
  const box = canvasBox.value;
  const rightmost = box.right - width - RIM;
  const lowest = box.bottom - height - DIMENSIONS;
  const [right, left] = [x + gap[0], x - gap[0] - width];
  const [below, above] = [y + gap[1], y - gap[1] - height];
  const wishes: Vec2[] = [
    [right, below],
    [left, below],
    [right, above],
    [left, above],
    [rightmost, lowest],
    [box.left + RIM, lowest],
    [rightmost, box.top],
    [box.left + RIM, box.top],
  ];
  return wishes.map(([wishX, wishY]) => ({
    left: Math.max(box.left + RIM, Math.min(rightmost, wishX)),
    top: Math.max(box.top + RIM, Math.min(lowest, wishY)),
    width,
    height,
  }));
}

/**
 * The first place that covers no corner and none of `taken`. Where there is no such it is not free,
 * and covers corners rather than what is taken.
 */
export function placeNear(
  spot: Vec2,
  size: Size,
  gap: Vec2,
  taken: readonly Rect[],
): Rect & { free: boolean } {
  const { px, py } = projection.value;
  const held = drawing.value.points.map(([x, z]) => around([px(x), py(z)], GRIP));
  const wanted = places(spot, size, gap);
  const clearOf = (rects: readonly Rect[]) =>
    wanted.find((place) => !rects.some((rect) => overlap(place, rect)));
  const free = clearOf([...held, ...taken]);
  return { ...(free ?? clearOf(taken) ?? wanted[0]!), free: free !== undefined };
}
