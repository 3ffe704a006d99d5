/** What stops the robot: the sentence, the numbers, and a line to the place. */

import { computed } from "@preact/signals";
import type { Problem } from "../api/types";
import { degrees, fixed } from "../geometry/format";
import { canUndo, undo } from "../state/drawing";
import { outdated, plan, preview } from "../state/planning";
import { Icon } from "../ui/icon";
import { lastEdit } from "./last-edit";
import { around, overlap, type Rect } from "./place";
import { canvasBox, centreOn, projection, size, tight } from "./viewport";

/** Needed amounts above this mean: no amount is enough. */
const HOPELESS = 100;
const LENGTHS = new Set(["clearance", "reach"]);

const angle = (radians: number) => `${fixed(degrees(radians), 1)}°`;

/** The service's sentence with the units of the numbers below it. */
const inDegrees = (sentence: string) =>
  sentence.replace(/(\d+(?:\.\d+)?) rad\b/g, (_, radians: string) => angle(Number(radians)));

/** A limit in the problem's own unit; lengths below 1 m in mm. */
function quantity({ limit, kind }: Problem, value: number): string {
  const unit = limit?.unit;
  if (Math.abs(value) >= HOPELESS) return "more than any";
  if (unit === "m" || (!unit && LENGTHS.has(kind))) {
    return Math.abs(value) < 0.1 ? `${fixed(value * 1000, 0)} mm` : `${fixed(value, 3)} m`;
  }
  if (unit === "rad") return angle(value);
  if (unit === "Nm" || kind === "torque") return `${fixed(value, 1)} Nm`;
  return fixed(value, 2) + (unit && unit !== "1" ? ` ${unit}` : "");
}

/** Poses that were found since are newer than the problem. */
const problem = computed(() => (preview.value ? null : (plan.value?.problem ?? null)));

/** Of the ring around the spot [px]. */
const RADIUS = 13;
/** Of the card at its fullest; narrow pages show less on it [px]. */
const WIDE = { width: 340, height: 190 };
const NARROW = { width: 292, height: 144 };

/**
 * Where the card lies: upper left, or where it leaves the spot open. What else floats over the
 * canvas keeps off it.
 */
export const card = computed<Rect | null>(() => {
  const stop = problem.value;
  if (!stop) return null;
  const { left, right, top, bottom } = canvasBox.value;
  const { px, py } = projection.value;
  const ring = around([px(stop.at[0]), py(stop.at[1])], 2 * RADIUS);
  const extent = tight.value ? NARROW : WIDE;
  const far = right - extent.width - 16;
  const low = bottom - extent.height - 16;
  const places = [
    [left + 16, top + 36],
    [far, top + 36],
    [left + 16, low],
    [far, low],
  ].map(([x, y]) => ({ left: x!, top: y!, ...extent }));
  return places.find((place) => !overlap(place, ring)) ?? places[0]!;
});

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
  const from = at.top + 54;
  const sentence = outdated.value ? null : lastEdit();
  return (
    <>
      {visible && (
        <svg class="whyline" width={size.value.width} height={size.value.height} aria-hidden="true">
          <circle cx={x} cy={y} r={RADIUS} />
          {!tight.value && x > edge + 20 && (
            <path d={`M${edge} ${from}H${bend}L${x} ${y < from ? y + RADIUS : y - RADIUS}`} />
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
          {inDegrees(stop.message.charAt(0).toUpperCase() + stop.message.slice(1))}
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
