/** What stops the robot, or the planner: the sentence, how far it comes, and a line to the place. */

import { computed } from "@preact/signals";
import { fixed, reason } from "../geometry/format";
import { PlanOtherEnd } from "../plan/other-end";
import { why } from "../plan/why";
import { canUndo, isEmpty, undo } from "../state/drawing";
import { outdated, plan, preview, refusal } from "../state/planning";
import { Icon } from "../ui/icon";
import { lastEdit } from "./last-edit";
import {
  around,
  bannerEnd,
  clearOf,
  corners,
  hidesLegend,
  highest,
  overlap,
  READOUT,
  type Rect,
} from "./place";
import { canvasBox, centreOn, projection, size, tight } from "./viewport";

/** The service would not even try: the drawing itself is not a terrain. */
const refused = computed(() => (isEmpty.value ? null : refusal.value));

/** Poses that were found since are newer than the problem, and so is what was refused. */
const stopped = computed(() => {
  const shown = refused.value ? null : (preview.value ?? plan.value);
  return shown?.problem ? shown : null;
});

/** Of the ring around the spot [px]. */
const RADIUS = 13;
/** Of the card: its width, and what stands around and below its sentence [px]. */
const WIDE = 340;
const NARROW = 292;
const PADDING = 12;
const LINE = 18;
const BUTTONS = 36;
const NUMBERS = 44;
/** Letters for which a line may end early: a number stays with its unit. */
const UNBROKEN = 14;
/** Of a letter of the sentence, and left of it [px]. */
const LETTER = 7.2;
const ICON = 24;
/** From the canvas's rim [px]. */
const RIM = 8;
/** Legend of the canvas; the dimensions along its lower rim [px]. */
const LEGEND = 36;
const DIMENSIONS = 40;

/** The robot where the plan stops, as a box on the canvas. */
const robotBox = computed<Rect | null>(() => {
  const pose = plan.value?.poses.at(-1);
  if (!pose) return null;
  const { px, py } = projection.value;
  const points = [...pose.collision_points, ...pose.wheels];
  const xs = points.map((p) => px(p[0]));
  const ys = points.map((p) => py(p[1]));
  const [left, top] = [Math.min(...xs), Math.min(...ys)];
  return { left, top, width: Math.max(...xs) - left, height: Math.max(...ys) - top };
});

/** Of a sentence with its padding, in a card of a width [px]. */
function textHeight(sentence: string, width: number): number {
  const letters = (width - 2 * PADDING - ICON) / LETTER;
  return 2 * PADDING + LINE * Math.ceil((sentence.length + UNBROKEN) / letters);
}

const heightOf = (sentence: string, width: number) =>
  textHeight(sentence, width) + (tight.value ? 0 : NUMBERS) + BUTTONS;

/** Below the legend, which the banner takes the place of. */
const belowLegend = () => bannerEnd() ?? canvasBox.value.top + LEGEND;

/** Corners, the legend's place, and all of the upper and lower rims. */
function places(sentence: string): Rect[] {
  const { left, right, bottom } = canvasBox.value;
  const [top, legend] = [highest(), belowLegend()];
  const width = tight.value ? NARROW : WIDE;
  const height = heightOf(sentence, width);
  const [near, far] = [left + 2 * RIM, right - width - 2 * RIM];
  const low = bottom - height - DIMENSIONS;
  const across = right - left - 2 * RIM;
  const strip = heightOf(sentence, across);
  return [
    { left: near, top: legend, width, height },
    { left: far, top: legend, width, height },
    { left: near, top: low, width, height },
    { left: far, top: low, width, height },
    { left: near, top, width, height },
    { left: far, top, width, height },
    { left: left + RIM, top: bottom - strip - RIM, width: across, height: strip },
    { left: left + RIM, top, width: across, height: strip },
  ];
}

/**
 * Where the card lies: where the read-out of a corner finds a place beside it, and it leaves spot
 * and robot open, or at least the spot. What else floats over the canvas keeps off it.
 */
export const card = computed<Rect | null>(() => {
  if (refused.value) {
    const width = tight.value ? NARROW : WIDE;
    const height = LINE + textHeight(refused.value, width);
    return { left: canvasBox.value.left + 2 * RIM, top: belowLegend(), width, height };
  }
  const shown = stopped.value;
  const stop = shown?.problem;
  if (!shown || !stop) return null;
  const { px, py } = projection.value;
  const ring = around([px(stop.at[0]), py(stop.at[1])], 2 * RADIUS);
  const robot = robotBox.value;
  const forReadout = corners(READOUT);
  const hidden = (place: Rect) =>
    (clearOf(forReadout, [place]) ? 0 : 4) +
    (overlap(place, ring) ? 2 : 0) +
    (robot && overlap(place, robot) ? 1 : 0);
  return places(why(shown)).reduce((best, next) => (hidden(next) < hidden(best) ? next : best));
});

const placed = ({ left, top, width }: Rect) => ({
  left: `${left}px`,
  top: `${top}px`,
  width: `${width}px`,
});

export function Refusal() {
  if (!refused.value || !card.value) return null;
  return (
    <section
      class={`tag why refused ${hidesLegend(card.value)}`}
      aria-label="Not a terrain"
      style={placed(card.value)}
    >
      <h4>
        <Icon name="warning" />
        This profile cannot be planned
      </h4>
      <p>{reason(refused.value)}</p>
    </section>
  );
}

export function Obstruction() {
  const shown = stopped.value;
  const stop = shown?.problem;
  const at = card.value;
  if (!shown || !stop || !at) return null;
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
        class={`tag why ${hidesLegend(at)}`}
        aria-label="What stops the robot"
        style={placed(at)}
      >
        <h4>
          {preview.value ? <span class="spin" /> : <Icon name="warning" />}
          {why(shown)}
        </h4>
        <dl>
          <dt>where</dt>
          <dd>
            x {fixed(stop.at[0], 2)}, z {fixed(stop.at[1], 2)} m
          </dd>
          <dt>progress</dt>
          <dd>{fixed(stop.progress, 2)} m</dd>
        </dl>
        {sentence && <p>{sentence}</p>}
        <div class="acts">
          <PlanOtherEnd of={shown} />
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
