/** Which margins are ample, fair, thin or critical, and how they read. */

import type { Margins, Plan, Pose } from "../api/types";
import { fixed, millimetres } from "../geometry/format";

export type MarginName = keyof Margins;
export type MarginClass = 0 | 1 | 2 | 3;

export const CLASS_NAMES = ["critical", "thin", "fair", "ample"] as const;

interface MarginKind {
  name: MarginName;
  title: string;
  /** Upper bounds of critical, thin and fair. */
  bounds: [number, number, number];
  /** What counts as all there could be, for the plot in percent. */
  full: number;
  read: (worst: number, plan: Plan) => string;
}

export const MARGINS: readonly MarginKind[] = [
  {
    name: "clearance",
    title: "Clearance",
    bounds: [0.002, 0.008, 0.016],
    full: 0.05,
    read: millimetres,
  },
  { name: "com", title: "CoM", bounds: [0.004, 0.02, 0.04], full: 0.12, read: millimetres },
  {
    name: "friction",
    title: "Friction",
    bounds: [0.01, 0.06, 0.14],
    full: 0.6,
    read: (worst, plan) => `${fixed(plan.friction - worst, 2)} / ${fixed(plan.friction, 2)}`,
  },
  {
    name: "torque",
    title: "Torque",
    bounds: [0.5, 4, 9],
    full: 33.5,
    read: (worst) => `${fixed(worst, 1)} Nm`,
  },
];

export function marginClass(kind: MarginKind, value: number): MarginClass {
  const [critical, thin, fair] = kind.bounds;
  if (value < critical) return 0;
  if (value < thin) return 1;
  return value < fair ? 2 : 3;
}

export function worst(poses: readonly Pose[], name: MarginName): number {
  return poses.reduce(
    (least, pose) => Math.min(least, pose.margins[name]),
    Number.POSITIVE_INFINITY,
  );
}
