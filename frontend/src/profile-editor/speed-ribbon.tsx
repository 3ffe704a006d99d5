/** How fast a plan is along its CoM path: a ribbon as wide as the speed, in the limit's pattern. */

import { computed } from "@preact/signals";
import type { Plan, Vec2 } from "../api/types";
import { fixed } from "../geometry/format";
import { LIMITS, limitTitle, planSpeeds, type Stretch, stretches } from "../geometry/speed-limits";
import { plan, planKept } from "../state/planning";
import { layers } from "../state/view";
import { type Projection, projection } from "./viewport";

/** Half of the ribbon's width where the plan stands, and where it is fastest [px]. */
const LEAST = 2;
const MOST = 15;

interface Ribbon {
  plan: Plan;
  parts: Stretch[];
  /** At each pose [m/s]. */
  speeds: number[];
}

/** Of a plan that is timed by its limits; null for others. */
export const ribbon = computed<Ribbon | null>(() => {
  const shown = planKept.value && layers.value.has("speed") ? plan.value : null;
  const limits = shown?.timing.limits;
  if (!shown || limits?.length !== shown.poses.length) return null;
  return { plan: shown, parts: stretches(limits), speeds: planSpeeds(shown) };
});

/** Points to both sides of the path, as far off as the robot is fast. */
function sides({ plan: shown, speeds }: Ribbon, to: Projection): [Vec2, Vec2][] {
  const most = Math.max(...speeds, 1e-6);
  const path = shown.poses.map(({ com }): Vec2 => [to.px(com[0]), to.py(com[1])]);
  return path.map(([x, y], i) => {
    const before = path[Math.max(0, i - 1)]!;
    const after = path[Math.min(path.length - 1, i + 1)]!;
    const [dx, dy] = [after[0] - before[0], after[1] - before[1]];
    const half = (LEAST + (MOST - LEAST) * (speeds[i]! / most)) / (Math.hypot(dx, dy) || 1);
    return [
      [x - dy * half, y + dx * half],
      [x + dy * half, y - dx * half],
    ];
  });
}

const text = ([x, y]: Vec2) => `${x.toFixed(1)},${y.toFixed(1)}`;

/** Outline of a stretch, up to the pose at which the next one begins. */
function outline(edges: [Vec2, Vec2][], { from, to }: Stretch): string {
  const part = edges.slice(from, Math.min(edges.length, to + 1));
  const there = part.map(([left]) => text(left));
  const back = part.map(([, right]) => text(right)).reverse();
  return `M${[...there, ...back].join("L")}Z`;
}

export function SpeedRibbon() {
  const shown = ribbon.value;
  if (!shown) return null;
  const edges = sides(shown, projection.value);
  return (
    <g class="ribbon">
      {shown.parts.map((part, k) => {
        const most = Math.max(...shown.speeds.slice(part.from, part.to));
        return (
          <path key={k} class={part.name} d={outline(edges, part)}>
            <title>{`up to ${fixed(most, 2)} m/s, limited by ${limitTitle(part.name)}`}</title>
          </path>
        );
      })}
    </g>
  );
}

/** Patterns of the limits: as in the timeline's band, where the most common one is plain too. */
export function RibbonPatterns() {
  return (
    <>
      {PATTERNED.map((name) => (
        <pattern
          key={name}
          id={`limit-${name}`}
          class={`limit-${name}`}
          width="6"
          height="6"
          patternUnits="userSpaceOnUse"
          patternTransform={name in TURNED ? `rotate(${TURNED[name]})` : undefined}
        >
          <rect width={name === "torque" ? 6 : 2.5} height="6" />
        </pattern>
      ))}
    </>
  );
}

const PATTERNED = Object.keys(LIMITS).filter((name) => name !== "acceleration");
const TURNED: Readonly<Record<string, number>> = {
  balance: 45,
  pitch_speed: 90,
  wheel_speed: 135,
  impact: 22,
};
