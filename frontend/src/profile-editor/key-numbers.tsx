/** Numbers over the key poses, above the robot: a click sets the clock to when it is there. */

import type { Vec2 } from "../api/types";
import { robot } from "../state/planning";
import { keyTimes, playing, seek } from "../state/playback";
import { layers } from "../state/view";
import { keyed, keyIndices } from "./poses";
import { projection, skyTop } from "./viewport";

/** Nearer than this two would touch, and the later one is left out [px]. */
const APART = 20;

/** Of a number, below the legend [px]. */
const ROOM = 24;

interface Badge {
  /** Which of the critical poses. */
  k: number;
  at: Vec2;
}

function badges(): Badge[] {
  const shown = keyed.value;
  if (!shown) return [];
  const { px, py } = projection.value;
  const half = (robot.value?.trunk.height ?? 0.1) / 2;
  const out: Badge[] = [];
  for (const index of keyIndices.value) {
    const pose = shown.poses[index];
    const k = shown.critical.indexOf(index);
    if (!pose || k < 0) continue;
    const trunk = py(pose.z_c + half);
    const above = trunk - 14 - Math.abs(pose.pitch) * 20;
    // Below the legend, but not below its robot where that is out of view.
    const at: Vec2 = [px(pose.x_c), Math.max(above, Math.min(trunk, skyTop() + ROOM))];
    const last = out[out.length - 1]?.at;
    if (!last || Math.hypot(at[0] - last[0], at[1] - last[1]) >= APART) out.push({ k, at });
  }
  return out;
}

/** Sets the clock where a key pose was pressed; whether one was. */
export function pressKey(event: PointerEvent): boolean {
  const badge = (event.target as Element).closest<SVGElement>("[data-key]");
  const time = badge && keyTimes.peek()[Number(badge.dataset.key)];
  // What a rollout did not reach has no time.
  if (typeof time !== "number" || event.button !== 0) return false;
  playing.value = false;
  seek(time);
  return true;
}

export function KeyNumbers() {
  if (!robot.value || !layers.value.has("keys")) return null;
  return (
    <g class="kb">
      {badges().map(({ k, at }) => (
        <g key={k} data-key={k} transform={`translate(${at[0].toFixed(1)} ${at[1].toFixed(1)})`}>
          <circle class="grab" r={12} />
          <circle r={8} />
          <text y={3.5} text-anchor="middle">
            {k + 1}
          </text>
        </g>
      ))}
    </g>
  );
}
