/** The field over a dimension while its number is typed. */

import { signal } from "@preact/signals";
import { fixed } from "../geometry/format";
import { commit, draft, drawing, revert } from "../state/drawing";
import { NumberField } from "../ui/number-field";
import { setDimension } from "./edits";
import { canvasBox, projection } from "./viewport";

export const editingDimension = signal<{ segment: number; which: "run" | "rise" } | null>(null);

export function DimensionField() {
  const editing = editingDimension.value;
  if (!editing) return null;
  const points = drawing.value.points;
  const a = points[editing.segment];
  const b = points[editing.segment + 1];
  if (!a || !b) return null;
  const { px, py } = projection.value;
  const box = canvasBox.value;
  const run = editing.which === "run";
  const x0 = Math.max(box.left, px(a[0]));
  const x = run ? (x0 + Math.min(box.right, px(b[0]))) / 2 : px(a[0]) + 34;
  const y = run ? box.bottom - 26 : (py(a[1]) + py(b[1])) / 2;
  const close = () => {
    editingDimension.value = null;
  };
  return (
    <div class="dim-field" style={{ left: `${x - 34}px`, top: `${y - 14}px` }}>
      <NumberField
        focus
        label={run ? "Run in metres" : "Rise in metres"}
        value={run ? b[0] - a[0] : b[1] - a[1]}
        min={run ? 0 : -5}
        max={run ? 50 : 5}
        step={0.005}
        format={(v) => fixed(v, 3)}
        onChange={(v) => draft({ points: setDimension(points, editing.segment, editing.which, v) })}
        onDone={() => {
          commit();
          close();
        }}
        onCancel={() => {
          revert();
          close();
        }}
      />
    </div>
  );
}
