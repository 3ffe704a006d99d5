/** What is shown while a plan takes longer than anyone would overlook. */

import { connected } from "../state/connection";
import { plan, preview } from "../state/planning";
import { slow } from "../state/waiting";
import { card } from "./obstruction";
import { clearOf, corners, legendRect } from "./place";
import { readout } from "./readout";
import { size } from "./viewport";

/** Of its letters at most, of what stands around them, and its height [px]. */
const LETTER = 6.2;
const AROUND = 48;
const HEIGHT = 28;

function text(): string {
  if (!plan.value) return "Planning";
  if (preview.value?.problem) return "Planning the latest edit";
  if (preview.value) return "Key poses shown; the full path follows";
  return "Planning the latest edit; the last plan is shown";
}

/** In a corner of the canvas where nothing else floats; without one the top bar alone tells. */
export function Veil() {
  if (!slow.value || !connected.value) return null;
  const told = text();
  const [low, lowLeft, top, ...others] = corners({
    width: AROUND + LETTER * told.length,
    height: HEIGHT,
  });
  const taken = [card.value, readout.value, legendRect()].filter((rect) => rect !== null);
  const at = clearOf([top!, low!, lowLeft!, ...others], taken);
  if (!at) return null;
  const right = size.value.width - at.left - at.width;
  return (
    <div class="plan-veil" style={{ right: `${right}px`, top: `${at.top}px` }}>
      <span class="spin" />
      {told}
    </div>
  );
}
