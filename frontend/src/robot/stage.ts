/** The small view of the terrain that A and B share. */

import { computed, signal } from "@preact/signals";
import { extent } from "../geometry/profile";
import type { Projection } from "../profile-editor/viewport";
import { drawing } from "../state/drawing";
import { robotDocument } from "../state/setup";
import { rivalDocument } from "./rival";

export const previewSize = signal({ width: 0, height: 0 });

/** Flat ground that is shown before and behind the obstacle, in standing heights. */
const BESIDE = 2;
const MARGIN = 10;

export const fitted = computed<Projection>(() => {
  const { width, height } = previewSize.value;
  const points = drawing.value.points;
  const tall = Math.max(
    robotDocument.value?.nominal_height ?? 0,
    rivalDocument.value?.nominal_height ?? 0,
    0.3,
  );
  const all = points.length > 1 ? extent(points) : { x: [-1, 1], z: [0, 0] };
  const inner = points.length > 2 ? extent(points.slice(1, -1)) : all;
  const left = Math.max(all.x[0]!, inner.x[0]! - BESIDE * tall);
  const right = Math.min(all.x[1]!, inner.x[1]! + BESIDE * tall);
  const top = all.z[1]! + 1.5 * tall;
  const scale = Math.max(
    1,
    Math.min(width / (right - left), (height - 2 * MARGIN) / (top - all.z[0]!)),
  );
  const x0 = (left + right) / 2;
  const px = (x: number) => width / 2 + (x - x0) * scale;
  const py = (z: number) => height - MARGIN - (z - all.z[0]!) * scale;
  return { px, py, scale, at: (p) => `${px(p[0]).toFixed(1)},${py(p[1]).toFixed(1)}` };
});
