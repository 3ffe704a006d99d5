/** What each plot shows, from the plan alone or from plan and rollout. */

import type { Drive, Plan } from "../api/types";
import { degrees } from "../geometry/format";
import { interpolate, planar } from "../geometry/frames";
import { MARGINS, type MarginName } from "../profile-editor/margins";
import { limitLines } from "./limits";
import {
  type Color,
  desired,
  type Line,
  PANELS,
  type Panel,
  type PanelId,
  planned,
  type Source,
  sampled,
} from "./lines";

const NOSE_UP = -1;

/** A line whose value the header tells. */
const line = (
  label: string,
  color: Color,
  values: Float64Array,
  name: string,
  digits: number,
): Line => ({ label, color, kind: "line", values, read: { name, digits } });

function pitchPanel(source: Source, time: Float64Array): Panel {
  const { run, runB } = source;
  const nose = (v: number) => NOSE_UP * degrees(v);
  const top: Line[] = [
    {
      label: "desired",
      color: "tx",
      kind: "band",
      values: desired(
        time,
        source,
        (r, i) => nose(r.series.pitch_desired[i]!),
        (p, i) => nose(p.poses[i]!.pitch),
      ),
      ...(run ? {} : { read: { name: "", digits: 1 } }),
    },
  ];
  const error: Line[] = [];
  let cross: Panel["cross"];
  if (runB) {
    const s = runB.series;
    const end = s.time[s.time.length - 1]!;
    const pitch = s.pitch.map(nose);
    top.push({
      label: "B actual",
      color: "tx3",
      kind: "dash",
      values: time.map((t) => (t > end ? Number.NaN : interpolate(s.time, pitch, t))),
    });
    if (runB.outcome !== "success") cross = { time: end, value: pitch[pitch.length - 1]! };
  }
  if (run) {
    const { pitch, pitch_desired } = run.series;
    top.push(
      line(
        "actual",
        "tx",
        sampled(time, run, (i) => nose(pitch[i]!)),
        "",
        1,
      ),
    );
    error.push(
      line(
        "error",
        "tx2",
        sampled(time, run, (i) => nose(pitch[i]! - pitch_desired[i]!)),
        "err",
        1,
      ),
    );
  }
  return {
    id: "pitch",
    title: PANELS.pitch,
    unit: "°",
    time,
    halves: run ? [top, error] : [top],
    spans: [8, 2],
    caption: "error",
    ...(cross ? { cross } : {}),
  };
}

/** Front and rear joints apart: their angles have opposite signs on many robots. */
function jointPanel(id: "thigh" | "calf", source: Source, time: Float64Array): Panel {
  const offset = id === "thigh" ? 0 : 1;
  const half = (joint: number, color: "front" | "rear"): Line[] => {
    const lines: Line[] = [
      {
        label: `${color} desired`,
        color,
        kind: "band",
        values: desired(
          time,
          source,
          (r, i) => degrees(planar(r.series.q_desired[i]!)[joint]!),
          (p, i) => degrees(p.poses[i]!.q[joint]!),
        ),
        ...(source.run ? {} : { read: { name: color, digits: 0 } }),
      },
    ];
    if (source.run) {
      const { q } = source.run.series;
      lines.push(
        line(
          `${color} actual`,
          color,
          sampled(time, source.run, (i) => degrees(planar(q[i]!)[joint]!)),
          color,
          0,
        ),
      );
    }
    return lines;
  };
  return {
    id,
    title: PANELS[id],
    unit: "°",
    time,
    halves: [half(offset, "front"), half(2 + offset, "rear")],
    spans: [20, 20],
  };
}

const largest = (row: readonly number[], columns: readonly number[]) =>
  columns.reduce((most, k) => Math.max(most, Math.abs(row[k]!)), 0);

function torquePanel(source: Source, time: Float64Array): Panel {
  const { plan, run } = source;
  const lines: Line[] = [];
  const torque = run?.series.torque;
  let limits = source.limits ? limitLines(source.limits, ["thigh", "calf"]) : [];
  if (run && torque) {
    if (source.limits) limits = limitLines(source.limits, ["thigh", "calf", "wheel"]);
    const of = (columns: number[]) => sampled(time, run, (i) => largest(torque[i]!, columns));
    lines.push(
      line("front leg", "front", of([0, 1, 3, 4]), "", 1),
      line("rear leg", "rear", of([6, 7, 9, 10]), "", 1),
      line("wheel", "third", of([2, 5, 8, 11]), "", 1),
    );
  } else if (plan) {
    // A plan tells how far the motor with least to spare is from its limit.
    const alike = limits.length === 1;
    limits = limits.slice(-1);
    const limit = limits[0]?.value ?? Number.NaN;
    const values = planned(time, plan, (i) => limit - plan.poses[i]!.margins.torque);
    lines.push({
      label: alike ? "static, largest" : "limit less least margin",
      color: "tx",
      kind: "band",
      values,
      read: { name: "static", digits: 1 },
    });
  }
  return {
    id: "torque",
    title: PANELS.torque,
    unit: "Nm",
    time,
    halves: [lines],
    spans: [10],
    ...(limits[0] ? { limits, range: [0, limits[0].value * 1.08] } : {}),
  };
}

/** Name, letter, colour, and the unit that the header tells it in: factor, digits, name. */
const MARGIN_LINES: [MarginName, string, Color, number, number, string][] = [
  ["clearance", "clr", "tx", 1000, 0, "mm"],
  ["com", "CoM", "third", 1000, 0, "mm"],
  ["friction", "μ", "fourth", 1, 2, ""],
];

/** Margins in percent of what is plenty, at the progress the robot had at each time. */
function marginPanel(source: Source, time: Float64Array): Panel {
  const { plan, run } = source;
  const lines = MARGIN_LINES.map(([name, label, color, factor, digits, unit]): Line => {
    const full = MARGINS.find((m) => m.name === name)!.full;
    const values = plan ? marginValues(time, plan, run, name) : time.map(() => Number.NaN);
    return {
      label,
      color,
      kind: "line",
      values: values.map((v) => Math.min(1, Math.max(0, v / full)) * 100),
      raw: values.map((v) => v * factor),
      read: { name: label, digits, unit },
    };
  });
  return {
    id: "margins",
    title: PANELS.margins,
    unit: "%",
    time,
    halves: [lines],
    spans: [100],
    range: [0, 103],
  };
}

function marginValues(
  time: Float64Array,
  plan: Plan,
  run: Drive | null,
  name: MarginName,
): Float64Array {
  const values = plan.poses.map((p) => p.margins[name]);
  if (!run) return planned(time, plan, (i) => values[i]!);
  const along = plan.poses.map((p) => p.progress);
  return sampled(time, run, (i) => interpolate(along, values, run.series.progress[i]!));
}

function forcePanel(source: Source, time: Float64Array): Panel {
  const { run } = source;
  const force = run?.series.contact_force;
  const pair = (a: number, axis: number) =>
    run && force
      ? sampled(time, run, (i) => {
          const f = force[i]!;
          return f[a]![axis]! + f[a + 1]![axis]!;
        })
      : time.map(() => Number.NaN);
  const half = (axis: number, read: boolean): Line[] =>
    (["front", "rear"] as const).map((color, k) => ({
      label: `${color} ${axis === 0 ? "tangential" : "normal"}`,
      color,
      kind: "line",
      values: pair(2 * k, axis),
      ...(read ? { read: { name: color, digits: 0 } } : {}),
    }));
  return {
    id: "force",
    title: PANELS.force,
    unit: "N",
    time,
    halves: force ? [half(1, true), half(0, false)] : [[], []],
    spans: [40, 20],
    caption: "tangential",
  };
}

function wheelPanel(source: Source, time: Float64Array): Panel {
  const { run } = source;
  const lines: Line[] = [];
  const torque = run?.series.torque;
  if (run && torque) {
    const mean = (a: number, b: number) =>
      sampled(time, run, (i) => (torque[i]![a]! + torque[i]![b]!) / 2);
    lines.push(
      line("front wheels", "front", mean(2, 5), "front", 2),
      line("rear wheels", "rear", mean(8, 11), "rear", 2),
    );
  }
  return { id: "wheel", title: PANELS.wheel, unit: "Nm", time, halves: [lines], spans: [2] };
}

const BUILT: Record<PanelId, (source: Source, time: Float64Array) => Panel> = {
  pitch: pitchPanel,
  thigh: (source, time) => jointPanel("thigh", source, time),
  calf: (source, time) => jointPanel("calf", source, time),
  torque: torquePanel,
  margins: marginPanel,
  force: forcePanel,
  wheel: wheelPanel,
};

export const buildPanel = (id: PanelId, source: Source, time: Float64Array): Panel =>
  BUILT[id](source, time);
