/** What plots are made of: lines on one time axis, from plan and rollout. */

import type { Drive, Plan, Rollout } from "../api/types";
import { delay, interpolate, poseTimes } from "../geometry/frames";
import type { RobotShape } from "../geometry/robot";

import type { LimitLine } from "./limits";

export type LineKind = "band" | "line" | "dash";
export type Color = "tx" | "tx2" | "tx3" | "front" | "rear" | "third" | "fourth";

export interface Line {
  label: string;
  color: Color;
  kind: LineKind;
  values: Float64Array;
  /** What header and table tell where the line is drawn in percent. */
  raw?: Float64Array;
  /** Shown as a number in the header: its short name, digits, and unit where not the panel's. */
  read?: { name: string; digits: number; unit?: string };
}

export interface Panel {
  id: PanelId;
  title: string;
  unit: string;
  time: Float64Array;
  /** One or two plots above each other on one time axis. */
  halves: Line[][];
  /** Least spans of the halves' value axes. */
  spans: number[];
  caption?: string;
  /** Motors' torques that lines must stay below. */
  limits?: LimitLine[];
  range?: [number, number];
  /** Where B ended early. */
  cross?: { time: number; value: number };
}

export interface Source {
  plan: Plan | null;
  run: Drive | null;
  runB: Rollout | null;
  /** Of the front and the rear motors. */
  limits: RobotShape["limits"] | null;
}

export const PANELS = {
  pitch: "Pitch, nose-up",
  thigh: "Thigh",
  calf: "Calf",
  torque: "Peak torque",
  margins: "Margins",
  force: "Contact force",
  wheel: "Wheel torque",
} as const;
export type PanelId = keyof typeof PANELS;

/** Time axis: the rollout's samples, then the plan's where the robot never got to. */
export function timeAxis({ plan, run }: Source): Float64Array {
  if (!run) return Float64Array.from(plan ? poseTimes(plan) : []);
  const end = run.series.time[run.series.time.length - 1] ?? 0;
  const late = plan ? delay(plan, run) : 0;
  const tail =
    run.outcome === "success" || !plan
      ? []
      : poseTimes(plan)
          .map((t) => t + late)
          .filter((t) => t > end + 1e-6);
  return Float64Array.from([...run.series.time, ...tail]);
}

/** Values at the rollout's samples, NaN where it has none. */
export function sampled(
  time: Float64Array,
  run: Drive,
  value: (i: number) => number,
): Float64Array {
  const n = run.series.time.length;
  return time.map((_, i) => (i < n ? value(i) : Number.NaN));
}

/** The plan's values on the time axis, `late` seconds after they were planned. */
export function planned(
  time: Float64Array,
  plan: Plan,
  value: (i: number) => number,
  late = 0,
): Float64Array {
  const times = late === 0 ? poseTimes(plan) : poseTimes(plan).map((t) => t + late);
  const values = plan.poses.map((_, i) => value(i));
  const end = times[times.length - 1] ?? 0;
  return time.map((t) => (t > end + 1e-9 ? Number.NaN : interpolate(times, values, t)));
}

/** What was asked for: by the controller while it ran, by the plan as it was followed after that. */
export function desired(
  time: Float64Array,
  source: Source,
  ofRun: (run: Drive, i: number) => number,
  ofPlan: (plan: Plan, i: number) => number,
): Float64Array {
  const { plan, run } = source;
  const rest = plan
    ? planned(time, plan, (i) => ofPlan(plan, i), run ? delay(plan, run) : 0)
    : time.map(() => Number.NaN);
  if (!run) return rest;
  const n = run.series.time.length;
  return time.map((_, i) => (i < n ? ofRun(run, i) : rest[i]!));
}
