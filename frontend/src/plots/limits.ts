/** The motors' peak torques as lines of a plot: one for each that differs, with whose it is. */

import { fixed } from "../geometry/format";
import type { MotorLimits } from "../geometry/robot";

export interface LimitLine {
  /** Whose it is, such as "front thigh"; of all legs alike "leg". */
  of: string;
  value: number;
}

/** As the plot names it. */
export const limitText = ({ of, value }: LimitLine): string => `${of} limit ${fixed(value, 1)}`;

const PAIRS = ["front", "rear"] as const;

/** What joints of both pairs, or of a whole leg, are called together. */
function together(names: string[]): string {
  const all = (...wanted: string[]) => wanted.every((name) => names.includes(name));
  const parts: string[] = [];
  const take = (whole: string, ...wanted: string[]) => {
    if (!all(...wanted)) return;
    parts.push(whole);
    for (const name of wanted) names.splice(names.indexOf(name), 1);
  };
  take("leg", "front thigh", "front calf", "rear thigh", "rear calf");
  for (const joint of ["thigh", "calf", "wheel"]) take(joint, `front ${joint}`, `rear ${joint}`);
  for (const pair of PAIRS) take(`${pair} leg`, `${pair} thigh`, `${pair} calf`);
  return [...parts, ...names].join(", ");
}

/** The limits of the given joints, highest first. */
export function limitLines(
  limits: readonly [MotorLimits, MotorLimits],
  joints: readonly (keyof MotorLimits)[],
): LimitLine[] {
  const owners = new Map<number, string[]>();
  PAIRS.forEach((pair, k) => {
    for (const joint of joints) {
      const value = limits[k]![joint];
      owners.set(value, [...(owners.get(value) ?? []), `${pair} ${joint}`]);
    }
  });
  return [...owners]
    .filter(([value]) => Number.isFinite(value))
    .map(([value, names]) => ({ of: together(names), value }))
    .sort((a, b) => b.value - a.value);
}
