/** The figures of a rollout: name, unit, value, and whether it is a bad one. */

import { hasFailed, type Metrics, type Outcome, type Plan, type Rollout } from "../api/types";
import { degrees, fixed, maybe } from "../geometry/format";
import { legLimits, type RobotShape } from "../geometry/robot";

export const OUTCOMES: Record<Outcome, string> = {
  success: "Success",
  fell: "Fell",
  stuck: "Stuck",
  collided: "Collided",
  diverged: "Diverged",
  timeout: "Ran out of time",
  stopped: "Stopped safely",
};

/** Beside other figures there is room for a word. */
const SHORT: Partial<Record<Outcome, string>> = { timeout: "Out of time", stopped: "Stopped" };

/** How it ended, as a class: a robot that stopped stands unharmed, others did not arrive. */
export const verdict = (outcome: Outcome): "" | "caution" | "bad" =>
  outcome === "success" ? "" : outcome === "stopped" ? "caution" : "bad";

export interface Figure {
  title: string;
  /** Which of several. */
  note?: string;
  /** The most it can be; told where there is room. */
  limit?: string;
  /** What the plan says of it, beside the title. */
  planned?: (plan: Plan | null) => string;
  hint?: string;
  /** The plan is the one that was run; null where it is gone. */
  of: (m: Metrics, r: Rollout, plan: Plan | null) => string;
  bad?: (m: Metrics, r: Rollout) => boolean;
}

/** More than this, and the robot was not tracking any more [rad]. */
const LOST = (10 * Math.PI) / 180;

type Limits = RobotShape["limits"];

/** What a motor lacks to its limit where it counts as being there [Nm]. */
const NEAR = 0.05;

/** Whether a thigh or calf gave all that its motor can. */
function atLimit({ series }: Rollout, [front, rear]: Limits): boolean {
  // Joints come as thigh, calf, wheel of FL, FR, RL, RR.
  const most = [front, front, rear, rear].flatMap(({ thigh, calf }) => [thigh, calf, Infinity]);
  return (series.torque ?? []).some((joints) =>
    joints.some((torque, k) => Math.abs(torque) >= most[k]! - NEAR),
  );
}

/** Whether a motor gave more than it can give without end. */
const tooHot = ({ metrics }: Rollout): boolean => (metrics.continuous_share ?? 0) > 1;

/** Told where there is room, or a motor gets too hot. */
const torqueRms: Figure = {
  title: "Torque",
  note: "rms",
  hint: "Largest root mean square of a thigh’s or calf’s torque, which heats its motor; marked where it is more than a motor’s continuous torque",
  of: (m) => maybe(m.torque_rms, 1, " Nm"),
  bad: (_m, r) => tooHot(r),
};

/** What a plan states of its motors' work. */
export const PLANNED: readonly {
  title: string;
  /** Where another figure has that title and there is little room. */
  short: string;
  hint: string;
  of: (plan: Plan | null) => string;
}[] = [
  {
    title: "Energy",
    short: "Energy",
    hint: "Work of the motors’ static torques along the plan, without losses",
    of: (plan) => maybe(plan?.energy, 0, " J"),
  },
  {
    title: "Cost of transport",
    short: "CoT",
    hint: "Cost of transport: that work per unit of weight and planned distance, without unit",
    of: (plan) => maybe(plan?.cost_of_transport, 2),
  },
];

/**
 * Of one rollout, or of several to compare: only then their outcomes are among the figures.
 * What was planned has rows of its own where it stands `apart`, else it stands beside a title.
 */
export function figures(
  results: readonly Rollout[],
  limits: Limits | undefined,
  apart: boolean,
): Figure[] {
  const outcome: Figure = {
    title: "Outcome",
    of: (_m, r) => SHORT[r.outcome] ?? OUTCOMES[r.outcome],
    bad: (_m, r) => hasFailed(r),
  };
  const motors = limits ? legLimits(limits).map((each) => fixed(each, 1)) : [];
  return [
    ...(results.length > 1 ? [outcome] : []),
    {
      title: "Duration",
      of: (m) => `${fixed(m.duration, 1)} s`,
      bad: (_m, r) => hasFailed(r),
    },
    { title: "Mean speed", hint: "Along the course", of: (m) => `${fixed(m.speed_mean, 2)} m/s` },
    {
      title: "On the stairs",
      hint: "Mean speed along the path of the wheels, from the first contact with the first face to all wheels on the landing",
      of: (m) => maybe(m.speed_stairs, 2, " m/s"),
    },
    {
      title: "Pitch error",
      note: "max",
      of: (m) => `${fixed(degrees(m.pitch_error_max), 1)}°`,
      bad: (m) => m.pitch_error_max > LOST,
    },
    { title: "Pitch error", note: "rms", of: (m) => `${fixed(degrees(m.pitch_error_rms), 1)}°` },
    {
      title: "Joint error",
      note: "rms",
      hint: "Thighs and calves",
      of: (m) => `${fixed(degrees(m.joint_error_rms), 1)}°`,
    },
    {
      title: "Peak torque",
      // Several are too long for the row.
      ...(motors.length === 1 ? { limit: `of ${motors[0]}` } : {}),
      hint: `Largest of thighs and calves; their motors give ${motors.join(" and ")} Nm`,
      of: (m) => `${fixed(m.torque_peak, 1)} Nm`,
      bad: (_m, r) => limits !== undefined && atLimit(r, limits),
    },
    ...(apart || results.some(tooHot) ? [torqueRms] : []),
    {
      title: "Energy",
      hint: "Work that the motors did or took up in the rollout",
      ...(apart ? {} : { planned: PLANNED[0]!.of }),
      of: (m) => `${fixed(m.energy, 0)} J`,
    },
    {
      title: "Cost of transport",
      hint: "That work per unit of weight and distance, without unit",
      ...(apart ? {} : { planned: PLANNED[1]!.of }),
      of: (m) => maybe(m.cost_of_transport, 2),
    },
    ...(apart ? PLANNED : []).map(({ short, hint, of }) => ({
      title: short,
      note: "planned",
      hint,
      of: (_m: Metrics, _r: Rollout, plan: Plan | null) => of(plan),
    })),
    { title: "Link contacts", of: (m) => String(m.link_contacts), bad: (m) => m.link_contacts > 0 },
  ];
}
