/** Where a wheel's centre can be, as its joint ranges allow it. */

import type { RobotDocument, Vec2 } from "../api/types";
import type { LegShape } from "../geometry/robot";

const STEPS = 40;

function wheel(leg: LegShape, thigh: number, calf: number): Vec2 {
  const below = (angle: number, length: number): Vec2 => [
    -length * Math.sin(angle),
    -length * Math.cos(angle),
  ];
  const knee = below(thigh, leg.thigh.length);
  const end = below(thigh + calf, leg.calf.length);
  return [leg.hip[0] + knee[0] + end[0], leg.hip[1] + knee[1] + end[1]];
}

const between = (a: number, b: number): number[] =>
  Array.from({ length: STEPS + 1 }, (_, i) => a + ((b - a) * i) / STEPS);

/**
 * Closed lines round the region, in the trunk frame: the image of the rectangle of both ranges.
 * A knee that bends both ways has two, one a side, since the image folds where the leg is straight.
 */
export function reachOutlines(leg: LegShape, limits: RobotDocument["joints"]["front"]): Vec2[][] {
  const [t0, t1] = [limits.thigh[0]!, Math.min(limits.thigh[1]!, limits.thigh[0]! + 2 * Math.PI)];
  const [low, high] = [Math.max(-Math.PI, limits.calf[0]!), Math.min(Math.PI, limits.calf[1]!)];
  const sides =
    low < 0 && high > 0 ? [[low, 0] as const, [0, high] as const] : [[low, high] as const];
  return sides.map(([c0, c1]) => [
    ...between(t0, t1).map((t) => wheel(leg, t, c0)),
    ...between(c0, c1).map((c) => wheel(leg, t1, c)),
    ...between(t1, t0).map((t) => wheel(leg, t, c1)),
    ...between(c1, c0).map((c) => wheel(leg, t0, c)),
  ]);
}
