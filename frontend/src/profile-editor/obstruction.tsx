/** What stops the robot: the sentence, how far it comes, and a line to the place. */

import { computed } from "@preact/signals";
import type { Problem } from "../api/types";
import { capital, degrees, fixed } from "../geometry/format";
import { canUndo, undo } from "../state/drawing";
import { outdated, plan, preview } from "../state/planning";
import { Icon } from "../ui/icon";
import { lastEdit } from "./last-edit";
import { around, overlap, type Rect } from "./place";
import { canvasBox, centreOn, projection, size, tight } from "./viewport";

/** The service's sentence, its angles in degrees. */
const inDegrees = (sentence: string) =>
  sentence.replace(
    /(\d+(?:\.\d+)?) rad\b/g,
    (_, radians: string) => `${fixed(degrees(Number(radians)), 1)}°`,
  );

/** No line ends between a number, what it is equal to, and its unit. */
const unbroken = (sentence: string) =>
  sentence.replace(/ = | (?=(?:m|Nm)\b)/g, (space) => space.replaceAll(" ", "\u00a0"));

/** Poses that were found since are newer than the problem. */
const problem = computed(() => (preview.value ? null : (plan.value?.problem ?? null)));

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

function heightOf(stop: Problem, width: number): number {
  const letters = (width - 2 * PADDING - ICON) / LETTER;
  const lines = Math.ceil((stop.message.length + UNBROKEN) / letters);
  const more = tight.value ? 0 : NUMBERS;
  return 2 * PADDING + lines * LINE + more + BUTTONS;
}

/** Corners, the legend's place, and all of the lower rim. */
function places(stop: Problem): Rect[] {
  const { left, right, top, bottom } = canvasBox.value;
  const width = tight.value ? NARROW : WIDE;
  const height = heightOf(stop, width);
  const [near, far] = [left + 2 * RIM, right - width - 2 * RIM];
  const low = bottom - height - DIMENSIONS;
  const across = right - left - 2 * RIM;
  const strip = heightOf(stop, across);
  return [
    { left: near, top: top + LEGEND, width, height },
    { left: far, top: top + LEGEND, width, height },
    { left: near, top: low, width, height },
    { left: far, top: low, width, height },
    { left: near, top: top + RIM, width, height },
    { left: far, top: top + RIM, width, height },
    { left: left + RIM, top: bottom - strip - RIM, width: across, height: strip },
  ];
}

/**
 * Where the card lies: where it leaves spot and robot open, or at least the spot. What else floats
 * over the canvas keeps off it.
 */
export const card = computed<Rect | null>(() => {
  const stop = problem.value;
  if (!stop) return null;
  const { px, py } = projection.value;
  const ring = around([px(stop.at[0]), py(stop.at[1])], 2 * RADIUS);
  const robot = robotBox.value;
  const hidden = (place: Rect) =>
    (overlap(place, ring) ? 2 : 0) + (robot && overlap(place, robot) ? 1 : 0);
  return places(stop).reduce((best, next) => (hidden(next) < hidden(best) ? next : best));
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
          {unbroken(inDegrees(capital(stop.message)))}
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
