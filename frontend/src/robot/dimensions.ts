/** The dimension lines of the side view: what each measures, and where a hand pulls it.
 *
 * They are stacked outside the outline as on a technical drawing, the shorter nearer to it, and
 * those of a leg lie on the side to which its knee points: there they part and never cross. */

import type { RobotDocument, Vec2 } from "../api/types";
import { distance, type Skeleton } from "../geometry/robot";
import type { Projection } from "../profile-editor/viewport";
import { told } from "./handle";
import { quantityOf } from "./quantities";

export interface Label {
  /** Centre and size of the label [px]. */
  label: Vec2;
  size: Vec2;
}

export interface Dimension extends Label {
  /** Of the quantity. */
  id: string;
  text: string;
  /** Ends of what is measured, on screen [px]. */
  from: Vec2;
  to: Vec2;
  /** The line lies this far beside it [px]. */
  aside: Vec2;
  /** Which way a pull makes it longer, and by how much per metre. */
  pull: Vec2;
  gain: number;
}

/** Between the outline and the first line, and from one line to the next [px]. */
const FIRST = 26;
const NEXT = 30;

/** How far beside a link its length is drawn [px]. */
const LINK = 30;

/** Between the trunk's front or rear and the line of its height: beyond the hip's arc [px]. */
const TRUNK_HEIGHT = 46;

/** Between the outline and the line that leads away from it [px]. */
const GAP = 4;

/** Of a label: a character and what is round the text [px]. */
const CHARACTER = 6.1;
const ROUND = 12;
const TALL = 20;

/** With less room beside the middle names are short, and the trunk's height stands in the table
 * alone [px]. */
const NARROW = 260;

type End = "front" | "rear";

/** Which way along x a leg's dimensions lie: 1 forward, -1 backward. */
type Side = 1 | -1;

const unit = (a: Vec2, b: Vec2): Vec2 => {
  const d: Vec2 = [b[0] - a[0], b[1] - a[1]];
  const length = Math.hypot(...d) || 1;
  return [d[0] / length, d[1] / length];
};

/** To where the knee points. */
const kneeSide = ([hip, knee, wheel]: Vec2[]): Side => {
  const across =
    (wheel![0] - hip![0]) * (knee![1] - hip![1]) - (wheel![1] - hip![1]) * (knee![0] - hip![0]);
  return across > 0 ? -1 : 1;
};

export function dimensions(
  file: RobotDocument,
  bones: Skeleton,
  to: Projection,
  width: number,
  caption: Label,
): Dimension[] {
  const px = (p: Vec2): Vec2 => [to.px(p[0]), to.py(p[1])];
  const legs = bones.legs.map((joints) => joints.map(px)) as [Vec2[], Vec2[]];
  const [front, rear] = legs;
  const corners = bones.outline.flat().map(px);
  const top = Math.min(...corners.map((p) => p[1]), ...(bones.payload ?? []).map((p) => px(p)[1]));
  const narrow = to.px(0) < NARROW;
  const trunk = bones.trunk.map(px) as [Vec2, Vec2, Vec2, Vec2];
  const radius = file.wheel.radius * to.scale;

  /** The label sits on the line, or beside it, away from what is measured. */
  const line = (
    id: string,
    name: string,
    from: Vec2,
    end: Vec2,
    aside: Vec2,
    { pull = unit(from, end), gain = 1, share = 0.5, beside = false } = {},
  ): Dimension => {
    const q = quantityOf(id);
    const text = `${name} ${told(q, q.read(file) ?? 0)}`;
    const size: Vec2 = [text.length * CHARACTER + ROUND, TALL];
    const along = [0, 1].map((k) => from[k]! + aside[k]! + (end[k]! - from[k]!) * share);
    const out = unit([0, 0], aside);
    const away = beside ? (Math.abs(out[0]) * size[0] + Math.abs(out[1]) * size[1]) / 2 + 2 : 0;
    const rim = size[0] / 2 + 3;
    const x = Math.min(width - rim, Math.max(rim, along[0]! + out[0] * away));
    return {
      id,
      text,
      from,
      to: end,
      aside,
      label: [x, along[1]! + out[1] * away],
      size,
      pull,
      gain,
    };
  };

  const ofLeg = (end: End, name: "thigh" | "calf", drawn: Vec2[]) => {
    const [a, b] = name === "thigh" ? [drawn[0]!, drawn[1]!] : [drawn[1]!, drawn[2]!];
    const [ux, uy] = unit(a, b);
    const side = kneeSide(drawn);
    const aside: Vec2 = [uy * side * LINK, -ux * side * LINK];
    // Between the legs the thigh's label hangs below the trunk, behind them below its height.
    const hangs = side === (drawn === front ? -1 : 1) || (own.length > 0 && side === -1);
    const share = name === "thigh" && hangs ? 0.95 : 0.5;
    return line(`${end}.${name}.length`, name, a, b, aside, { share, beside: true });
  };
  const own = (["thigh", "calf"] as const).filter((name) => file.rear?.[name]);
  // What both legs share is drawn at one whose knee points away from the robot.
  const outside = own.length === 0 && kneeSide(rear) === -1 ? rear : front;
  const links = [
    ...(["thigh", "calf"] as const).map((name) => ofLeg("front", name, outside)),
    ...own.map((name) => ofLeg("rear", name, rear)),
  ];
  const side = own.length > 0 ? 1 : kneeSide(outside);

  const lengths = [
    { id: "hips", name: narrow ? "hips" : "hip distance", ends: [rear[0]!, front[0]!] as const },
    {
      id: "trunk.length",
      name: narrow ? "trunk" : "trunk length",
      ends: [trunk[3], trunk[2]] as const,
    },
  ]
    .sort((a, b) => a.ends[1][0] - a.ends[0][0] - (b.ends[1][0] - b.ends[0][0]))
    .map(({ id, name, ends: [a, b] }, k) =>
      line(id, name, a, b, [0, top - FIRST - k * NEXT - a[1]], { pull: [1, 0], gain: 2 }),
    );

  const hub = rear[2]!;
  const rolling = line(
    "wheel.radius",
    "wheel radius",
    [hub[0] + radius, hub[1]],
    hub,
    [0, radius + 22],
    { pull: [-1, 0] },
  );

  /** The rim of all that is drawn on one side [px]. */
  const rimOf = (towards: Side, all: readonly Vec2[]) =>
    towards * Math.max(...all.map((p) => towards * p[0]));
  const heightSide: Side = side === 1 ? -1 : 1;
  const beyond = rimOf(heightSide, [...corners, front[0]!, rear[0]!]) + heightSide * GAP;
  const trunkHeight = line(
    "trunk.height",
    "trunk height",
    [beyond, trunk[0][1]],
    [beyond, trunk[3][1]],
    [heightSide * TRUNK_HEIGHT, 0],
    { pull: [0, -1], gain: 2, beside: true },
  );

  // Beside the legs' dimensions, or where there is no room for both, on the other side.
  const standingSide: Side = narrow ? heightSide : side;
  const labels = (narrow ? [] : links).map(
    ({ label, size }): Vec2 => [label[0] + (standingSide * size[0]) / 2, label[1]],
  );
  const rim = rimOf(standingSide, [...corners, ...legs.flat(), ...labels]);
  const [ground, hips] = [to.py(0), to.py(file.nominal_height)];
  const standing = line(
    "height",
    "standing",
    [rim, ground],
    [rim, hips],
    [standingSide * NEXT, 0],
    { pull: [0, -1], beside: !narrow },
  );
  const share = clearShare(narrow ? 0.16 : 0.4, standing, bones, radius, to);
  standing.label[1] = ground + (hips - ground) * share;
  const all = [rolling, ...lengths, ...links, standing, ...(narrow ? [] : [trunkHeight])];
  partLabels([caption, ...all]); // those at the rims first: they have no way out
  return all;
}

/** Moves labels up or down that lie over one before them. */
function partLabels(all: readonly Label[]): void {
  all.forEach(({ label, size }, k) => {
    for (const other of all.slice(0, k)) {
      const [across, down] = [0, 1].map((i) => label[i]! - other.label[i]!) as Vec2;
      const [wide, tall] = [0, 1].map((i) => (size[i]! + other.size[i]!) / 2) as Vec2;
      if (Math.abs(across) < wide && Math.abs(down) < tall)
        label[1] = other.label[1] + (down < 0 ? -tall : tall);
    }
  });
}

/** The share of an upright line nearest to `wanted` at which its label lies on no link or wheel. */
function clearShare(
  wanted: number,
  { from, to: end, label, size }: Dimension,
  bones: Skeleton,
  wheel: number,
  to: Projection,
): number {
  const px = (p: Vec2): Vec2 => [to.px(p[0]), to.py(p[1])];
  const links = bones.bars.flat().map((bar) => ({
    a: px(bar.from),
    b: px(bar.to),
    radius: bar.radius * to.scale,
  }));
  const wheels = bones.legs.map((joints) => {
    const hub = px(joints[2]!);
    return { a: hub, b: hub, radius: wheel };
  });
  const free = (share: number) => {
    const y = from[1] + (end[1] - from[1]) * share;
    const around = [-1, -0.5, 0, 0.5, 1].flatMap((k) =>
      [-1, 1].map((side): Vec2 => [label[0] + (k * size[0]) / 2, y + side * (size[1] / 2 + 3)]),
    );
    return around.every((p) =>
      [...links, ...wheels].every(({ a, b, radius }) => distance(p, a, b) > radius),
    );
  };
  const all = Array.from({ length: 46 }, (_, k) => 0.1 + k * 0.02);
  const nearest = [wanted, ...all.sort((p, q) => Math.abs(p - wanted) - Math.abs(q - wanted))];
  return nearest.find(free) ?? wanted;
}
