/** What the overlay draws of each pinned result: series over time and progress, and the CoM path. */

import { signal } from "@preact/signals";
import { getPlan, getRollout } from "../api/client";
import type { Entry } from "../api/stored";
import type { Plan, Rollout, Vec2 } from "../api/types";
import { centreOfMass } from "../geometry/centre-of-mass";
import { degrees } from "../geometry/format";
import { interpolate, planFrame, poseTimes, runFrame } from "../geometry/frames";
import { type Frame, type RobotShape, robotShape } from "../geometry/robot";
import { stated } from "../profile-editor/margins";
import { report } from "../state/connection";

export interface Track {
  /** [s] */
  time: number[];
  /** Share of the plan's course [%]. */
  progress: number[];
  /** Nose-up against what the plan asked for [degrees]; none for a plan. */
  pitchError: number[] | null;
  /** Largest of thighs and calves [Nm]; static for a plan. */
  torque: number[] | null;
  /** Of the planned pose at the same progress [mm]. */
  comMargin: number[] | null;
  /** Of the run, or of a plan as planned [m]. */
  com: Vec2[];
  /** The pose at a time [s]. */
  frameAt: (time: number) => Frame | null;
  /** None where the run's plan, which names the robot, is gone. */
  shape: RobotShape | null;
  terrain: readonly Vec2[];
}

const LEG = [0, 1, 3, 4, 6, 7, 9, 10];

/** By id; null while it is read or where it cannot be. */
export const tracks = signal<ReadonlyMap<string, Track | null>>(new Map());

export function load(entries: readonly Entry[]): void {
  for (const entry of entries) {
    if (entry.kind === "trials" || tracks.peek().has(entry.id)) continue;
    tracks.value = new Map(tracks.peek()).set(entry.id, null);
    read(entry)
      .then((track) => {
        tracks.value = new Map(tracks.peek()).set(entry.id, track);
      })
      .catch((error) => {
        // Asked for again when the pins change.
        const others = new Map(tracks.peek());
        others.delete(entry.id);
        tracks.value = others;
        report(error);
      });
  }
}

async function read(entry: Entry): Promise<Track> {
  if (entry.kind === "plans") return ofPlan(await getPlan(entry.id));
  const run = (await getRollout(entry.id)) as Rollout & { plan?: Plan | null };
  const plan = run.plan ?? (run.plan_id ? await getPlan(run.plan_id).catch(() => null) : null);
  return ofRollout(run, plan);
}

function ofPlan(plan: Plan): Track {
  const { poses } = plan;
  const end = poses.at(-1)?.progress || 1;
  const limit = Math.min(
    ...(["leg", "thigh", "calf"] as const).map(
      (name) => plan.robot_description.actuators[name]?.torque ?? Infinity,
    ),
  );
  return {
    time: poseTimes(plan),
    progress: poses.map((pose) => (100 * pose.progress) / end),
    pitchError: null,
    torque: Number.isFinite(limit) ? poses.map((pose) => limit - pose.margins.torque) : null,
    comMargin: poses.map((pose) => stated(pose.margins.com) * 1000),
    com: poses.map((pose) => pose.com),
    frameAt: (time) => planFrame(plan, time),
    shape: robotShape(plan.robot_description),
    terrain: plan.terrain.points,
  };
}

function ofRollout(run: Rollout, plan: Plan | null): Track {
  const { series } = run;
  const way = plan?.poses.map((pose) => pose.progress) ?? [];
  const margins = plan?.poses.map((pose) => stated(pose.margins.com) * 1000) ?? [];
  const end = way.at(-1) ?? series.progress.at(-1) ?? 1;
  return {
    time: series.time,
    progress: series.progress.map((value) => (100 * value) / (end || 1)),
    pitchError: series.pitch.map((value, i) => degrees(series.pitch_desired[i]! - value)),
    torque:
      series.torque?.map((row) => LEG.reduce((most, k) => Math.max(most, Math.abs(row[k]!)), 0)) ??
      null,
    comMargin:
      way.length > 1 ? series.progress.map((value) => interpolate(way, margins, value)) : null,
    com: plan ? driven(run, plan) : [],
    frameAt: (time) => runFrame(run, time),
    shape: plan && robotShape(plan.robot_description),
    terrain: plan?.terrain.points ?? [],
  };
}

/** Points of a line that is drawn a few hundred pixels wide. */
const FINE_ENOUGH = 400;

/** Where the robot's centre of mass really was. */
function driven(run: Rollout, plan: Plan): Vec2[] {
  const centre = centreOfMass(plan.robot_description);
  const { time } = run.series;
  const step = Math.max(1, Math.floor(time.length / FINE_ENOUGH));
  return time.flatMap((t, i) => {
    const frame = i % step === 0 || i === time.length - 1 ? runFrame(run, t) : null;
    return frame ? [centre(frame)] : [];
  });
}
