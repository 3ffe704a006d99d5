/** What stops the robot: the sentence, the numbers, and a line to the place. */

import { computed } from "@preact/signals";
import type { Problem } from "../api/types";
import { fixed } from "../geometry/format";
import { canUndo, drawing, previous, undo } from "../state/drawing";
import { plan, preview } from "../state/planning";
import { isNarrow } from "../state/view";
import { Icon } from "../ui/icon";
import type { Rect } from "./place";
import { canvasBox, centreOn, projection, size } from "./viewport";

/** Needed amounts above this mean: no amount is enough. */
const HOPELESS = 100;
const LENGTHS = new Set(["clearance", "reach"]);

/** A limit in the problem's own unit; lengths below 1 m in mm. */
function quantity({ limit, kind }: Problem, value: number): string {
  const unit = limit?.unit;
  if (Math.abs(value) >= HOPELESS) return "more than any";
  if (unit === "m" || (!unit && LENGTHS.has(kind))) {
    return Math.abs(value) < 0.1 ? `${fixed(value * 1000, 0)} mm` : `${fixed(value, 3)} m`;
  }
  if (unit === "rad") return `${fixed((value * 180) / Math.PI, 1)}°`;
  if (unit === "Nm" || kind === "torque") return `${fixed(value, 1)} Nm`;
  return fixed(value, 2) + (unit && unit !== "1" ? ` ${unit}` : "");
}

/** What the last edit changed, if it made one face higher or lower. */
function lastEdit(): string | null {
  const before = previous.value?.points;
  const after = drawing.value.points;
  if (!before || before.length !== after.length) return null;
  for (let i = 0; i + 1 < after.length; i++) {
    const upright = Math.abs(after[i + 1]![0] - after[i]![0]) < 1e-6;
    const old = before[i + 1]![1] - before[i]![1];
    const now = after[i + 1]![1] - after[i]![1];
    if (upright && Math.abs(now - old) > 1e-4) {
      const verb = Math.abs(now) > Math.abs(old) ? "raised" : "lowered";
      return `This edit ${verb} the riser from ${fixed(Math.abs(old), 3)} to ${fixed(Math.abs(now), 3)} m.`;
    }
  }
  return null;
}

/** Poses that were found since are newer than the problem. */
const problem = computed(() => (preview.value ? null : (plan.value?.problem ?? null)));

/** Where the card lies; what else floats over the canvas keeps off it. */
export const card = computed<Rect | null>(
  () => problem.value && { left: 52, top: 56, width: isNarrow.value ? 292 : 340, height: 168 },
);

export function Obstruction() {
  const stop = problem.value;
  const at = card.value;
  if (!stop || !at) return null;
  const { px, py } = projection.value;
  const box = canvasBox.value;
  const [x, y] = [px(stop.at[0]), py(stop.at[1])];
  const visible = x > box.left && x < box.right && y > box.top && y < box.bottom;
  const edge = at.left + at.width;
  const bend = Math.max(edge + 24, x - 35);
  const sentence = lastEdit();
  return (
    <>
      {visible && (
        <svg class="whyline" width={size.value.width} height={size.value.height} aria-hidden="true">
          <circle cx={x} cy={y} r={13} />
          {!isNarrow.value && x > edge + 20 && (
            <path d={`M${edge} ${at.top + 54}H${bend}L${x} ${y - 13}`} />
          )}
        </svg>
      )}
      <section
        class="tag why"
        aria-label="What stops the robot"
        style={{ left: `${at.left}px`, top: `${at.top}px`, width: `${at.width}px` }}
      >
        <h4>
          <Icon name="warning" />
          {stop.message.charAt(0).toUpperCase() + stop.message.slice(1)}
        </h4>
        <dl>
          <dt>where</dt>
          <dd>
            x {fixed(stop.at[0], 2)}, z {fixed(stop.at[1], 2)} m
          </dd>
          <dt>progress</dt>
          <dd>{fixed(stop.progress, 2)} m</dd>
          {stop.limit && (
            <>
              <dt>needed</dt>
              <dd>{quantity(stop, stop.limit.needed)}</dd>
              <dt>has</dt>
              <dd class="x">{quantity(stop, stop.limit.available)}</dd>
            </>
          )}
        </dl>
        {sentence && <p>{sentence}</p>}
        <div class="acts">
          {canUndo.value && (
            <button type="button" onClick={undo}>
              Undo edit
            </button>
          )}
          <button type="button" onClick={() => centreOn(stop.at)}>
            Go to spot
          </button>
        </div>
      </section>
    </>
  );
}
