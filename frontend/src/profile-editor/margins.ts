/** Which margins are ample, fair, thin or critical, and how they read. */

import type { Margins, Plan, Pose } from "../api/types";
import { fixed } from "../geometry/format";

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
  /** What a plan's worst is called: most where less is better. */
  extreme: "least" | "most";
  unit: string;
  /** What is measured, in a sentence. */
  hint: string;
  read: (margin: number, plan: Plan) => string;
}

/** Documents have this, or less, where nothing holds the robot and there is no such margin. */
const NONE = -1e3;

/** A margin as it can be told: not a number where there is none. */
export const stated = (margin: number) => (margin <= NONE ? Number.NaN : margin);

const inMillimetres = (metres: number) => fixed(stated(metres) * 1000, 0);

export const MARGINS: readonly MarginKind[] = [
  {
    name: "clearance",
    title: "Clearance",
    bounds: [0.002, 0.008, 0.016],
    full: 0.05,
    extreme: "least",
    unit: "mm",
    hint: "From the robot to the terrain, least of all collision points",
    read: inMillimetres,
  },
  {
    name: "com",
    title: "CoM",
    bounds: [0.004, 0.02, 0.04],
    full: 0.12,
    extreme: "least",
    unit: "mm",
    hint: "From the centre of mass to the edge of the region in which contact forces can hold it",
    read: inMillimetres,
  },
  {
    name: "friction",
    title: "μ needed",
    bounds: [0.01, 0.06, 0.14],
    full: 0.6,
    extreme: "most",
    unit: "",
    hint: "Least friction coefficient at which the wheels do not slip",
    read: (margin, plan) => fixed(plan.friction - stated(margin), 2),
  },
  {
    name: "torque",
    title: "Torque left",
    bounds: [0.5, 4, 9],
    full: 33.5,
    extreme: "least",
    unit: "Nm",
    hint: "From the largest static joint torque to the motors' limit",
    read: (margin) => fixed(stated(margin), 1),
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
