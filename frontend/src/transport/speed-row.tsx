/** Planned speed on the timeline's axis, over a band of the limit that holds it at each place. */

import { computed } from "@preact/signals";
import { fixed } from "../geometry/format";
import { LIMITS, limitTitle, planSpeeds, stretches } from "../geometry/speed-limits";
import { plan, planKept } from "../state/planning";
import { poseIndex } from "../state/playback";
import { marks, shareOf } from "./axis";

/** The drawing is stretched to the width of the axis. */
const WIDTH = 1000;

interface Profile {
  limits: readonly string[];
  speeds: number[];
  /** Shares of the axis; NaN where the robot did not get. */
  at: number[];
  most: number;
}

/** Of a plan that is timed by its limits; null for others. */
const profile = computed<Profile | null>(() => {
  const shown = planKept.value ? plan.value : null;
  const limits = shown?.timing.limits;
  if (!shown || !limits || limits.length !== shown.poses.length) return null;
  const speeds = planSpeeds(shown);
  const at = marks.value.map((value) => (Number.isNaN(value) ? value : shareOf(value)));
  return { limits, speeds, at, most: Math.max(...speeds, 1e-6) };
});

export function SpeedRow() {
  const shown = profile.value;
  if (!shown) return null;
  return (
    <div class="row speed">
      <Label {...shown} />
      <div class="speed-track">
        <svg viewBox={`0 0 ${WIDTH} 1`} preserveAspectRatio="none" aria-hidden="true">
          <path d={outline(shown)} />
        </svg>
        <Band {...shown} />
      </div>
    </div>
  );
}

/** Area under the speed, as path data in a box of 1000 by 1. */
function outline({ at, speeds, most }: Profile): string {
  const reached = at.findIndex((share) => Number.isNaN(share));
  const n = reached < 0 ? at.length : reached;
  if (n === 0) return "";
  const x = (i: number) => (at[i]! * WIDTH).toFixed(1);
  let path = `M${x(0)} 1`;
  for (let i = 0; i < n; i++) path += `L${x(i)} ${(1 - (0.94 * speeds[i]!) / most).toFixed(3)}`;
  return `${path}L${x(n - 1)} 1z`;
}

function Band({ at, limits }: Profile) {
  /** Between the middles of neighbouring poses. */
  const edge = (i: number) =>
    i <= 0 ? at[0]! : i >= at.length ? at[at.length - 1]! : (at[i - 1]! + at[i]!) / 2;
  return (
    <div class="speed-band">
      {stretches(limits).map(({ name, from, to }) => {
        const width = edge(to) - edge(from);
        if (!(width > 0)) return null;
        return (
          <i
            key={from}
            class={`limit ${name}`}
            style={{ left: `${edge(from) * 100}%`, width: `${width * 100}%` }}
          >
            <span>{limitTitle(name)}</span>
          </i>
        );
      })}
    </div>
  );
}

function Label({ limits, speeds, most }: Profile) {
  const i = Math.max(0, poseIndex.value);
  const name = limits[i] ?? "";
  return (
    <div
      class="ml"
      title="Planned speed along the course, and the limit that holds it at the cursor"
    >
      <span>Speed</span>
      <b>{fixed(speeds[i] ?? 0, 2)}</b>
      <small>most {fixed(most, 2)} m/s</small>
      <em title={LIMITS[name]?.hint}>
        <i class={`limit ${name}`} />
        <span>limited by </span>
        {limitTitle(name)}
      </em>
    </div>
  );
}

/** The limits that hold this plan somewhere, each with its pattern. */
export function SpeedLegend() {
  const limits = profile.value?.limits;
  if (!limits) return null;
  const present = Object.keys(LIMITS).filter((name) => limits.includes(name));
  return (
    <ul class="speed-legend" aria-label="What limits the speed">
      {present.map((name) => (
        <li key={name} title={LIMITS[name]!.hint}>
          <i class={`limit ${name}`} />
          {limitTitle(name)}
        </li>
      ))}
    </ul>
  );
}
