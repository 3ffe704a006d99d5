/** What the side view shows, and how large: it keeps its scale while a dimension is dragged. */

import { computed, signal } from "@preact/signals";
import type { Vec2 } from "../api/types";
import { type Frame, robotShape, type Skeleton, skeleton } from "../geometry/robot";
import { stance } from "../geometry/stance";
import type { Projection } from "../profile-editor/viewport";
import { robotAsBuilt, robotDocument } from "../state/setup";
import { base, posture } from "./edit";

export const LAYERS = {
  dimensions: "Dimensions",
  joints: "Joints",
  reach: "Reach",
  points: "Collision points",
} as const;
export type Layer = keyof typeof LAYERS;

export const shown = signal<ReadonlySet<Layer>>(new Set(["dimensions", "joints", "reach"]));

export function toggle(layer: Layer): void {
  const next = new Set(shown.peek());
  if (!next.delete(layer)) next.add(layer);
  shown.value = next;
}

export const size = signal({ width: 0, height: 0 });

/** Lengths that decide the scale, of the robot before it was changed [m]. */
const extent = computed(() => {
  const file = base.value ?? robotDocument.value;
  if (!file) return null;
  const shape = robotShape(file);
  const reach = shape.legs[0].thigh.length + shape.legs[0].calf.length;
  const corners = shape.outline.flat();
  const half = Math.max(...corners.map((p) => Math.abs(p[0])), file.hips.front[0]!);
  const joints = skeleton(shape, stance(file)).legs.flat();
  const stands = Math.max(half, ...joints.map((p) => Math.abs(p[0]) + file.wheel.radius));
  const height = file.nominal_height;
  return { half, stands, reach, height, top: height + Math.max(...corners.map((p) => p[1])) };
});

/** Narrower, and the robot as it stands takes the width; its reach may leave the picture [px]. */
const NARROW = 520;
/** On a narrow side view its labels lie over the ends of the lines [px]. */
const NARROW_SIDE = 66;

export const isNarrowView = computed(() => size.value.width < NARROW);

/** Ground line above the lower rim [px]. */
const GROUND = 46;
/** Room for dimension lines beside and above the robot [px]. */
const SIDE = 90;
const ABOVE = 60;
/** The same above a trunk that is higher than legs reach: an arm's. */
const ABOVE_TRUNK = 74;

export const projection = computed<Projection>(() => {
  const { width, height } = size.value;
  const of = extent.value;
  const narrow = isNarrowView.value;
  const wide = of ? 2 * (narrow ? of.stands : of.half + 0.5 * of.reach) : 1;
  const tall = of ? of.height + 0.5 * of.reach : 1;
  const fitted = Math.min(
    (width - 2 * (narrow ? NARROW_SIDE : SIDE)) / wide,
    (height - GROUND - ABOVE) / tall,
    (height - GROUND - ABOVE_TRUNK) / (of?.top ?? 1),
  );
  const scale = Math.max(20, fitted);
  const px = (x: number) => width / 2 + x * scale;
  const py = (z: number) => height - GROUND - z * scale;
  const round = (v: number) => Math.round(v * 10) / 10;
  return { px, py, scale, at: (p: Vec2) => `${round(px(p[0]))},${round(py(p[1]))}` };
});

export const frame = computed<Frame | null>(() => {
  const file = robotDocument.value;
  if (!file) return null;
  const stands = stance(file);
  return posture.value ? { ...stands, q: posture.value } : stands;
});

export const bones = computed<Skeleton | null>(() =>
  robotAsBuilt.value && frame.value ? skeleton(robotAsBuilt.value, frame.value) : null,
);
