/** The corners as controls, the stretches as handles, guides and the selection rectangle. */

import { computed } from "@preact/signals";
import type { Vec2 } from "../api/types";
import { fixed } from "../geometry/format";
import { cornerNames } from "../geometry/profile";
import { drawing, selection } from "../state/drawing";
import { tool } from "../state/view";
import { onVertexKey } from "./commands";
import { dragging, guides, marquee } from "./gestures";
import { pen } from "./pen";
import { canvasBox, centreOn, projection } from "./viewport";

export const names = computed(() => cornerNames(drawing.value.points));

/** With more corners than this, only those that can be told apart are drawn. */
const MANY = 150;
/** Corners nearer to each other than this cannot be told apart [px]. */
const APART = 6;

/** The corners to draw: all, or of many those in view that stand apart, and the selected one's
 * neighbours, so that Page Up and Page Down reach every corner. */
const drawn = computed<number[]>(() => {
  const points = drawing.value.points;
  if (points.length <= MANY) return points.map((_, i) => i);
  const { px, py } = projection.value;
  const chosen = selection.value[0] ?? Number.NEGATIVE_INFINITY;
  const out: number[] = [];
  let last: Vec2 = [Number.NaN, Number.NaN];
  points.forEach((p, i) => {
    const at: Vec2 = [px(p[0]), py(p[1])];
    const near = Math.abs(at[0] - last[0]) < APART && Math.abs(at[1] - last[1]) < APART;
    if (Math.abs(i - chosen) > 1 && (near || isHidden(p))) return;
    out.push(i);
    last = at;
  });
  return out;
});

export function Stretches() {
  if (tool.value !== "select") return null;
  const { at } = projection.value;
  const points = drawing.value.points;
  return (
    <g>
      {drawn.value.map((i) => {
        const b = points[i + 1];
        const ends = b && `${at(points[i]!)} ${at(b)}`;
        return ends && <polyline key={i} class="stretch" data-segment={i} points={ends} />;
      })}
    </g>
  );
}

/** A corner that takes the focus is selected, and comes into view. */
function onFocus(i: number): void {
  // Read at this moment: the drawing may have changed since it was last rendered.
  const p = drawing.peek().points[i];
  if (dragging.peek() || !p) return;
  if (!selection.peek().includes(i)) selection.value = [i];
  if (isHidden(p)) centreOn(p);
}

function isHidden(p: Vec2): boolean {
  const { left, right, top, bottom } = canvasBox.value;
  const [x, y] = [projection.value.px(p[0]), projection.value.py(p[1])];
  return x < left - 4 || x > right + 4 || y < top - 4 || y > bottom + 4;
}

export function Vertices() {
  const { px, py } = projection.value;
  const chosen = selection.value;
  const words = names.value;
  // All corners are one stop of the Tab key: the selected one, or the first.
  const stop = drawn.value.find((i) => i === chosen[0]) ?? drawn.value[0];
  return (
    <g>
      {drawn.value.map((i) => {
        const p = drawing.value.points[i]!;
        const [x, y] = [px(p[0]), py(p[1])];
        const selected = chosen.includes(i);
        const half = selected ? 4.5 : 3.5;
        return (
          <g
            key={i}
            class="vertex"
            role="button"
            tabindex={i === stop ? 0 : -1}
            aria-pressed={selected}
            aria-label={`${words[i]}, x ${fixed(p[0], 3)}, z ${fixed(p[1], 3)} m`}
            data-vertex={i}
            transform={`translate(${x.toFixed(1)} ${y.toFixed(1)})`}
            onKeyDown={onVertexKey}
            onFocus={() => onFocus(i)}
          >
            <circle class="hit" r={11} />
            <circle class={selected ? "vsel-h" : "vhalo"} r={10} />
            <rect
              class={selected ? "vsel" : "vx"}
              x={-half}
              y={-half}
              width={2 * half}
              height={2 * half}
              rx={selected ? 2 : 1.5}
            />
          </g>
        );
      })}
    </g>
  );
}

/** Lines from the selected corner to the rulers; to the neighbour it snapped to while dragged. */
export function Guides() {
  const i = selection.value[0];
  const p = selection.value.length === 1 && i !== undefined ? drawing.value.points[i] : undefined;
  const { px, py } = projection.value;
  const { left, top } = canvasBox.value;
  const box = marquee.value;
  const snapped = guides.value;
  const drawn = pen.value[pen.value.length - 1];
  return (
    <g>
      {drawn && <circle class="pen" cx={px(drawn[0])} cy={py(drawn[1])} r={5} />}
      {p && (
        <path
          class="guide"
          d={`M${left} ${py(p[1])}H${px(p[0]) - 6}M${px(p[0])} ${top}V${py(p[1]) - 6}`}
        />
      )}
      {snapped?.x && (
        <path
          class="guide on"
          d={`M${px(snapped.x[0])} ${py(snapped.x[1])}V${py(snapped.at[1])}`}
        />
      )}
      {snapped?.z && (
        <path
          class="guide on"
          d={`M${px(snapped.z[0])} ${py(snapped.z[1])}H${px(snapped.at[0])}`}
        />
      )}
      {box && (
        <rect
          class="marquee"
          x={Math.min(box[0], box[2])}
          y={Math.min(box[1], box[3])}
          width={Math.abs(box[2] - box[0])}
          height={Math.abs(box[3] - box[1])}
        />
      )}
    </g>
  );
}
