/** From metres to pixels on the canvas, and what the canvas looks at. */

import { computed, signal } from "@preact/signals";
import type { Vec2 } from "../api/types";
import { extent, type Points } from "../geometry/profile";
import { robot } from "../state/planning";

export const RULER_X = 20;
export const RULER_Z = 36;

export const size = signal({ width: 0, height: 0 });
/** World point at the canvas's lower left corner, and pixels per metre. */
interface View {
  x: number;
  z: number;
  scale: number;
}
export const view = signal<View>({ x: -0.75, z: -0.13, scale: 378 });
const fitted = signal(378);
/** Whether the user chose the view: it then stays as it is when the canvas changes its size. */
export const moved = signal(false);

export const canvasBox = computed(() => ({
  left: RULER_Z,
  top: RULER_X,
  right: size.value.width,
  bottom: Math.max(RULER_X + 40, size.value.height),
}));

export const zoomPercent = computed(() => Math.round((view.value.scale / fitted.value) * 100));

/** A canvas with little room says less. */
export const tight = computed(() => size.value.width <= 640);

/** Of the zoom: the widest profile, of 200 m, is all in view [px/m]. */
const LEAST = 2;
const MOST = 8000;

export interface Projection {
  px: (x: number) => number;
  py: (z: number) => number;
  /** The same as text with one decimal, for path data. */
  at: (p: Vec2) => string;
  scale: number;
}

export const projection = computed<Projection>(() => {
  const { x, z, scale } = view.value;
  const { left, bottom } = canvasBox.value;
  const px = (wx: number) => left + (wx - x) * scale;
  const py = (wz: number) => bottom - (wz - z) * scale;
  const round = (v: number) => Math.round(v * 10) / 10;
  return { px, py, scale, at: (p) => `${round(px(p[0]))},${round(py(p[1]))}` };
});

export function toWorld(x: number, y: number): Vec2 {
  const v = view.peek();
  const box = canvasBox.peek();
  return [v.x + (x - box.left) / v.scale, v.z + (box.bottom - y) / v.scale];
}

export function pan(dx: number, dy: number): void {
  const v = view.peek();
  moved.value = true;
  view.value = { ...v, x: v.x - dx / v.scale, z: v.z + dy / v.scale };
}

/** Zoom by `factor` and keep what is under the pixel (x, y) where it is. */
export function zoomAt(x: number, y: number, factor: number): void {
  const v = view.peek();
  const box = canvasBox.peek();
  moved.value = true;
  const scale = Math.min(MOST, Math.max(LEAST, v.scale * factor));
  const [wx, wz] = toWorld(x, y);
  view.value = { scale, x: wx - (x - box.left) / scale, z: wz - (box.bottom - y) / scale };
}

/** Room for the end corners at the rim, and for the dimensions below the ground [px]. */
const SIDE = 16;
const BELOW = 48;

/** A narrower canvas has no legend [px]. */
export const LEGEND_FROM = 440;
const LEGEND = 20;
/** Of the canvas that is free of rulers and legend [px]. */
export const skyTop = () => canvasBox.value.top + (size.value.width < LEGEND_FROM ? 0 : LEGEND);

/** What a robot needs before the first and after the last corner, and above the ground [m]. */
function roomOf(): { before: number; after: number; above: number } {
  const shape = robot.peek();
  if (!shape) return { before: 0.75, after: 0.7, above: 0.52 };
  const [front, rear] = shape.legs;
  const long = 2 * (front.hip[0] - rear.hip[0]) + 2 * shape.wheel;
  const legs = front.thigh.length + front.calf.length;
  return {
    before: Math.max(0.75, long),
    after: Math.max(0.7, long),
    above: Math.max(0.52, legs + shape.wheel + shape.trunk.height / 2),
  };
}

/** The view of the part between the long flat ends, with room for the robot above it. */
function framing(points: Points): View | null {
  const box = canvasBox.peek();
  const width = box.right - box.left - 2 * SIDE;
  const height = box.bottom - skyTop() - BELOW;
  if (width <= 0) return null;
  const needs = roomOf();
  const inner = points.length > 2 ? points.slice(1, -1) : points;
  const all = points.length > 1 ? extent(points) : { x: [-0.75, 1.8] as Vec2, z: [0, 0] as Vec2 };
  const mid = points.length > 2 ? extent(inner) : all;
  const x0 = Math.max(all.x[0], mid.x[0] - needs.before);
  const x1 = Math.min(all.x[1], mid.x[1] + needs.after);
  const tall = all.z[1] + needs.above - all.z[0];
  const scale = Math.min(MOST, Math.max(LEAST, Math.min(width / (x1 - x0), height / tall)));
  const spare = Math.max(0, width / scale - (x1 - x0));
  const sky = Math.max(0, height / scale - tall);
  return {
    scale,
    x: x0 - SIDE / scale - spare * 0.4,
    z: all.z[0] - BELOW / scale - sky * 0.3,
  };
}

/** Show all of the profile but its long flat ends. */
export function fit(points: Points): void {
  const best = framing(points);
  if (!best) return;
  moved.value = false;
  fitted.value = best.scale;
  view.value = best;
}

/** So much closer a view must be to be worth leaving the one that there is. */
const CLOSER = 1.5;

/** After an edit: fit again where the profile left the view or shrank in it, unless it was chosen. */
export function refit(points: Points): void {
  const best = framing(points);
  if (moved.peek() || !best || points.length < 3) return;
  const box = canvasBox.peek();
  const { px, py } = projection.peek();
  const { x } = extent(points.slice(1, -1));
  const { z } = extent(points);
  // A robot that is cut off a little is no reason to move what the hand has just moved.
  const top = z[1] + roomOf().above / 2;
  const seen = px(x[0]) > box.left && px(x[1]) < box.right && py(top) > box.top;
  if (!seen || py(z[0]) > box.bottom || best.scale > CLOSER * view.peek().scale) fit(points);
}

/** Bring a place to the middle without changing the zoom. */
export function centreOn(at: Vec2): void {
  const v = view.peek();
  const box = canvasBox.peek();
  view.value = {
    ...v,
    x: at[0] - (box.right - box.left) / v.scale / 2,
    z: at[1] - (box.bottom - box.top) / v.scale / 2,
  };
}

/** Grid spacings [m] that keep lines apart: fine ones and labelled ones. */
export function gridSteps(scale: number): { fine: number; coarse: number } {
  const ladder: [number, number][] = [
    [0.001, 0.005],
    [0.002, 0.01],
    [0.005, 0.025],
    [0.01, 0.05],
    [0.02, 0.1],
    [0.05, 0.25],
    [0.1, 0.5],
    [0.2, 1],
    [0.5, 2.5],
    [1, 5],
    [2, 10],
    [5, 25],
  ];
  const found = ladder.find(([fine]) => fine * scale >= 13) ?? ladder[ladder.length - 1]!;
  return { fine: found[0], coarse: found[1] };
}

export function multiples(from: number, to: number, step: number): number[] {
  const out: number[] = [];
  for (let i = Math.ceil(from / step); i * step <= to; i++) out.push(i * step);
  return out;
}
