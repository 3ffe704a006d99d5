/** How fast a plan drives at each of its poses, and which limit keeps it from being faster. */

import type { Plan } from "../api/types";
import { poseTimes } from "./frames";

interface LimitKind {
  title: string;
  /** What binds, in a sentence. */
  hint: string;
}

/** By the service's names. */
export const LIMITS: Readonly<Record<string, LimitKind>> = {
  balance: {
    title: "balance",
    hint: "Inertia would move the zero-moment point out of the share of the CoM margin it may use",
  },
  torque: {
    title: "leg torque",
    hint: "Standing and accelerating take all the leg motors may give",
  },
  acceleration: {
    title: "acceleration",
    hint: "CoM, trunk or joints accelerate as hard as the controller can follow",
  },
  joint_speed: { title: "joint speed", hint: "A thigh or calf turns as fast as it may" },
  pitch_speed: { title: "pitch rate", hint: "The trunk pitches as fast as it may" },
  wheel_speed: { title: "wheel speed", hint: "A wheel turns as fast as its motor allows" },
  impact: { title: "impact", hint: "A wheel meets the face ahead as fast as it may" },
};

export const limitTitle = (name: string): string => LIMITS[name]?.title ?? name;

/** Along the course at each pose [m/s]: over its neighbours, so that ends are one-sided. */
export function planSpeeds(plan: Plan): number[] {
  const times = poseTimes(plan);
  const { poses } = plan;
  return poses.map((_, i) => {
    const a = Math.max(0, i - 1);
    const b = Math.min(poses.length - 1, i + 1);
    const time = times[b]! - times[a]!;
    return time > 0 ? (poses[b]!.progress - poses[a]!.progress) / time : 0;
  });
}

/** Poses `from` to `to` (exclusive) that one limit holds. */
export interface Stretch {
  name: string;
  from: number;
  to: number;
}

export function stretches(names: readonly string[]): Stretch[] {
  const out: Stretch[] = [];
  names.forEach((name, i) => {
    const last = out[out.length - 1];
    if (last?.name === name) last.to = i + 1;
    else out.push({ name, from: i, to: i + 1 });
  });
  return out;
}
