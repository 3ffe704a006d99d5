/** What floats over the canvas: the legend, the lost service, the first hint. */

import { connected, retryIn, retryNow } from "../state/connection";
import { canUndo, drawing, selection } from "../state/drawing";
import { ghost } from "../state/effect";
import { plan, planB, planKept } from "../state/planning";
import { activity, run } from "../state/rollouts";
import { dismissHint, hintSeen, layers } from "../state/view";
import { Icon } from "../ui/icon";
import { legendRect } from "./place";
import { ribbon } from "./speed-ribbon";
import { size } from "./viewport";

export function Legend() {
  if (!legendRect()) return null;
  return (
    <div class="lg" aria-hidden="true">
      <span class="front">
        <i />
        front
      </span>
      <span class="rear">
        <i />
        rear
      </span>
      {layers.value.has("com") && (
        <span class="third">
          <i />
          CoM path
        </span>
      )}
      {layers.value.has("wheel") && (
        <span>
          <i class="dots" />
          wheel-centre path
        </span>
      )}
      {ribbon.value && (
        <span title="As wide as the plan is fast; the pattern is the limit that holds it there">
          <i class="ribbon" />
          speed
        </span>
      )}
      {ghost.value && (
        <span class="third">
          <i class="dash" />
          default path
        </span>
      )}
      {planB.value && (
        <span>
          <i class="dash" />
          B: nominal pose
        </span>
      )}
    </div>
  );
}

export function Banner() {
  if (connected.value) return null;
  return (
    <div class="ban">
      <Icon name="offline" />
      <b>No connection to the planner.</b>
      <span class="kept-edits">
        Your edits are kept and planned when it is back.
        <span class="wide"> Trying again in {retryIn.value} s</span>
      </span>
      <button type="button" onClick={retryNow}>
        Retry now
      </button>
    </div>
  );
}

/** A lower canvas has no sky to put a hint in [px]. */
const SKY = 240;

/** Until the first edit, in the sky, where nothing is to be reached; not under a verdict. */
export function FirstHint() {
  if (hintSeen.value || canUndo.value || selection.value.length > 0) return null;
  if (plan.value?.status !== "feasible" || drawing.value.points.length < 4) return null;
  if (activity.value !== "idle" || run.value || !planKept.value) return null;
  if (size.value.height < SKY) return null;
  return (
    <div class="hint">
      <b>Drag a corner: the poses follow.</b>
      <span>Then run it.</span>
      <button type="button" onClick={dismissHint}>
        Got it
      </button>
    </div>
  );
}
