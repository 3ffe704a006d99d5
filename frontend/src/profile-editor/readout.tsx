/** The selected corner in numbers, beside it. */

import { computed, signal } from "@preact/signals";
import { fixed } from "../geometry/format";
import { segmentKind } from "../geometry/profile";
import { commit, draft, drawing, revert, selection } from "../state/drawing";
import { tool } from "../state/view";
import { IconButton } from "../ui/icon-button";
import { NumberField } from "../ui/number-field";
import { deleteSelected, insertVertex } from "./commands";
import { moveVertices } from "./edits";
import { card } from "./obstruction";
import { hidesLegend, placeNear, READOUT } from "./place";
import { names } from "./vertices";
import { canvasBox, projection } from "./viewport";

/** A typed x that lay beyond a neighbour, and where it stopped instead. */
const stopped = signal<{ i: number; text: string } | null>(null);
/** Rounding is less than this [m]. */
const NOTED = 1e-3;

/** From its corner to the read-out, past the number of a rise [px]. */
const GAP: [number, number] = [64, 28];

function facts(i: number): string {
  const points = drawing.value.points;
  const p = points[i]!;
  const before = points[i - 1];
  const after = points[i + 1];
  const parts = [names.value[i]!];
  if (before && segmentKind(before, p) === "upright")
    parts.push(`rise ${fixed(p[1] - before[1], 3)}`);
  else if (after && segmentKind(p, after) === "upright")
    parts.push(`rise ${fixed(after[1] - p[1], 3)}`);
  if (after && segmentKind(p, after) !== "upright") parts.push(`run ${fixed(after[0] - p[0], 3)}`);
  else if (before && segmentKind(before, p) !== "upright")
    parts.push(`run ${fixed(p[0] - before[0], 3)}`);
  return parts.join(" · ");
}

/** Of the selected corners the one that the read-out tells. */
const told = computed(() => {
  const i = tool.value === "select" ? selection.value[0] : undefined;
  const p = i === undefined ? undefined : drawing.value.points[i];
  return i === undefined || !p ? null : { i, p };
});

/** Where the read-out lies: beside its corner, and on nothing else that floats. */
export const readout = computed(() => {
  if (!told.value) return null;
  const [wx, wz] = told.value.p;
  const { px, py } = projection.value;
  const box = canvasBox.value;
  // A typed number may take the corner out of view; its fields stay at the rim.
  const x = Math.min(box.right, Math.max(box.left, px(wx)));
  const y = Math.min(box.bottom, Math.max(box.top, py(wz)));
  return placeNear([x, y], READOUT, GAP, card.value ? [card.value] : []);
});

export function Readout() {
  const at = readout.value;
  if (!told.value || !at) return null;
  const { i, p } = told.value;
  const { left, top, width, free } = at;
  const chosen = selection.value;
  const points = drawing.value.points;
  const set = (axis: 0 | 1) => (value: number) => {
    const by = value - p[axis];
    const moved = moveVertices(points, chosen, axis === 0 ? by : 0, axis === 1 ? by : 0);
    const got = moved[i]![axis];
    stopped.value =
      Math.abs(got - value) < NOTED
        ? null
        : { i, text: `x stops at ${fixed(got, 3)} m, at the next corner` };
    draft({ points: moved });
  };
  const field = (axis: 0 | 1) => (
    <NumberField
      key={`${i} ${axis}`}
      label={axis === 0 ? "x of the corner in metres" : "z of the corner in metres"}
      value={p[axis]}
      min={-100}
      max={100}
      step={0.005}
      format={(v) => fixed(v, 3)}
      onChange={set(axis)}
      onDone={() => commit()}
      onCancel={revert}
    />
  );
  return (
    // Where it has to cover corners, only its fields keep the pointer.
    <div
      class={`tag ro ${free ? "" : "through"} ${hidesLegend(at)}`}
      style={{ left: `${left}px`, top: `${top}px`, width: `${width}px` }}
    >
      <small aria-hidden="true">x</small>
      {field(0)}
      <small aria-hidden="true">z</small>
      {field(1)}
      <IconButton action={insertVertex} label="Add a corner after it" icon="plus" off={false} />
      <IconButton action={deleteSelected} label="Delete it" icon="trash" off={false} />
      <em aria-live="polite">
        {stopped.value?.i === i
          ? stopped.value.text
          : chosen.length > 1
            ? `${chosen.length} corners move together`
            : facts(i)}
      </em>
    </div>
  );
}
