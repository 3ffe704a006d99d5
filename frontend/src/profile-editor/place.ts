/** Where something may float over the canvas: near a spot, and on nothing that a hand must reach. */

import type { Vec2 } from "../api/types";
import { connected } from "../state/connection";
import { drawing, isEmpty } from "../state/drawing";
import { canvasBox, LEGEND_FROM, projection, size } from "./viewport";

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

/** The read-out of a corner, with room for its longest words, on two lines [px]. */
export const READOUT: Size = { width: 258, height: 78 };

/** Where the legend lies at most, in two lines; and the banner, on a narrow canvas [px]. */
const LEGEND: Rect = { left: 52, top: 28, width: 440, height: 36 };
const BANNER = 56;

export const legendRect = (): Rect | null =>
  isEmpty.value || size.value.width < LEGEND_FROM ? null : LEGEND;

/** Half a word says nothing: the class of what hides the legend by lying over it. */
export const hidesLegend = (place: Rect) => (overlap(place, LEGEND) ? "in-sky" : "");

export const bannerEnd = (): number | null =>
  connected.value ? null : canvasBox.value.top + BANNER;

/** From where on anything may float: nothing covers the banner. */
export const highest = () => bannerEnd() ?? canvasBox.value.top + RIM;

/** The canvas's corners, the lower ones above the dimensions; last of all over those. */
export function corners({ width, height }: Size): Rect[] {
  const box = canvasBox.value;
  const [left, right] = [box.left + RIM, box.right - width - RIM];
  const lowest = box.bottom - height;
  return [lowest - DIMENSIONS, highest(), lowest - RIM].flatMap((top) => [
    { left: right, top, width, height },
    { left, top, width, height },
  ]);
}

/** Beside the spot, below it first, where the ground is. */
function beside([x, y]: Vec2, { width, height }: Size, gap: Vec2): Rect[] {
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
  ];
  return wishes.map(([wishX, wishY]) => ({
    left: Math.max(box.left + RIM, Math.min(rightmost, wishX)),
    top: Math.max(highest(), Math.min(lowest, wishY)),
    width,
    height,
  }));
}

/** The first place that covers none of `taken`. */
export const clearOf = (places: readonly Rect[], taken: readonly Rect[]) =>
  places.find((place) => !taken.some((rect) => overlap(place, rect)));

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
  const places = [...beside(spot, size, gap), ...corners(size)];
  const free = clearOf(places, [...held, ...taken]);
  return { ...(free ?? clearOf(places, taken) ?? places[0]!), free: free !== undefined };
}
