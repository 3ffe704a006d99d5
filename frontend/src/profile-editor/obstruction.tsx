/** What stops the robot: the sentence, the numbers, and a line to the place. */

import type { Plan } from "../api/types";
import { fixed } from "../geometry/format";
import { canUndo, drawing, previous, undo } from "../state/drawing";
import { plan, preview } from "../state/planning";
import { isNarrow } from "../state/view";
import { Icon } from "../ui/icon";
import { canvasBox, centreOn, projection, size } from "./viewport";

/** Needed amounts above this mean: no amount is enough. */
const HOPELESS = 100;
const LENGTHS = new Set(["clearance", "reach"]);

/** A limit in the problem's own unit; lengths below 1 m in mm. */
function quantity(shown: Plan, value: number): string {
  const problem = shown.problem!;
  const unit = problem.limit?.unit;
  if (Math.abs(value) >= HOPELESS) return "more than any";
  if (unit === "m" || (!unit && LENGTHS.has(problem.kind))) {
    return Math.abs(value) < 0.1 ? `${fixed(value * 1000, 0)} mm` : `${fixed(value, 3)} m`;
  }
  if (unit === "rad") return `${fixed((value * 180) / Math.PI, 1)}°`;
  if (unit === "Nm" || problem.kind === "torque") return `${fixed(value, 1)} Nm`;
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

export function Obstruction() {
  const shown = plan.value;
  const problem = shown?.problem;
  // Poses that were found since are newer than the problem.
  if (!shown || !problem || preview.value) return null;
  const { px, py } = projection.value;
  const box = canvasBox.value;
  const [x, y] = [px(problem.at[0]), py(problem.at[1])];
  const visible = x > box.left && x < box.right && y > box.top && y < box.bottom;
  const card = { left: 52, top: 56, width: isNarrow.value ? 292 : 340 };
  const edge = card.left + card.width;
  const bend = Math.max(edge + 24, x - 35);
  const sentence = lastEdit();
  return (
    <>
      {visible && (
        <svg class="whyline" width={size.value.width} height={size.value.height} aria-hidden="true">
          <circle cx={x} cy={y} r={13} />
          {!isNarrow.value && x > edge + 20 && (
            <path d={`M${edge} ${card.top + 54}H${bend}L${x} ${y - 13}`} />
          )}
        </svg>
      )}
      <section
        class="tag why"
        aria-label="What stops the robot"
        style={{ left: `${card.left}px`, top: `${card.top}px`, width: `${card.width}px` }}
      >
        <h4>
          <Icon name="warning" />
          {problem.message.charAt(0).toUpperCase() + problem.message.slice(1)}
        </h4>
        <dl>
          <dt>where</dt>
          <dd>
            x {fixed(problem.at[0], 2)}, z {fixed(problem.at[1], 2)} m
          </dd>
          <dt>progress</dt>
          <dd>{fixed(problem.progress, 2)} m</dd>
          {problem.limit && (
            <>
              <dt>needed</dt>
              <dd>{quantity(shown, problem.limit.needed)}</dd>
              <dt>has</dt>
              <dd class="x">{quantity(shown, problem.limit.available)}</dd>
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
          <button type="button" onClick={() => centreOn(problem.at)}>
            Go to spot
          </button>
        </div>
      </section>
    </>
  );
}
