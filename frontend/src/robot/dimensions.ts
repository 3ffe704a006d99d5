/** The dimension lines of the side view: what each measures, and where a hand pulls it. */

import type { RobotDocument, Vec2 } from "../api/types";
import { distance, type Skeleton } from "../geometry/robot";
import type { Projection } from "../profile-editor/viewport";

export interface Dimension {
  /** Of the quantity. */
  id: string;
  label: string;
  /** Ends of what is measured, on screen [px]. */
  from: Vec2;
  to: Vec2;
  /** The line lies this far beside it [px]. */
  aside: Vec2;
  /** Where the label sits on the line, 0 to 1. */
  label_at: number;
  /** Which way a pull makes it longer, and by how much per metre. */
  pull: Vec2;
  gain: number;
}

/** How far behind the trunk its height is drawn: behind the hip's arc [px]. */
const TRUNK_HEIGHT = 96;

/** How far behind the robot its standing height is drawn [px]. */
const HEIGHT = 34;

/** How far beside a link its length is drawn [px]. */
const LINK = 62;

/** With less room beside the middle names are short, and the trunk's height stands in the table
 * alone [px]. */
const NARROW = 260;

/** Half the standing height's label, with air round it [px]. */
const STANDING: Vec2 = [51, 13];

const unit = (a: Vec2, b: Vec2): Vec2 => {
  const d: Vec2 = [b[0] - a[0], b[1] - a[1]];
  const length = Math.hypot(...d) || 1;
  return [d[0] / length, d[1] / length];
};

export function dimensions(file: RobotDocument, bones: Skeleton, to: Projection): Dimension[] {
  const px = (p: Vec2): Vec2 => [to.px(p[0]), to.py(p[1])];
  const [front, rear] = bones.legs.map((joints) => joints.map(px)) as [Vec2[], Vec2[]];
  const corners = bones.outline.flat().map(px);
  const top = Math.min(...corners.map((p) => p[1]), ...(bones.payload ?? []).map((p) => px(p)[1]));
  const ground = to.py(0);
  const back = Math.min(...corners.map((p) => p[0]));
  const narrow = to.px(0) < NARROW;
  const left = Math.min(narrow ? back : back - TRUNK_HEIGHT - 60, ...rear.map((p) => p[0]));
  const trunk = bones.trunk.map(px);
  const line = (
    id: string,
    label: string,
    from: Vec2,
    end: Vec2,
    aside: Vec2,
    pull: Vec2 = unit(from, end),
    gain = 1,
    label_at = 0.5,
  ): Dimension => ({ id, label, from, to: end, aside, label_at, pull, gain });
  const leg = (joints: Vec2[], end: "front" | "rear") =>
    ([0, 1] as const).map((i) => {
      const [a, b] = [joints[i]!, joints[i + 1]!];
      const [ux, uy] = unit(a, b);
      const out = end === "front" ? 1 : -1;
      // To the side that looks away from the robot.
      const side = -uy * out >= 0 ? 1 : -1;
      const name = i === 0 ? "thigh" : "calf";
      const aside: Vec2 = [-uy * side * LINK, ux * side * LINK];
      // Where both lines cross, before the one knee, their labels do not.
      const apart = narrow ? 0.02 : 0.3;
      const label_at = i === 0 ? apart : 1 - apart;
      return line(`${end}.${name}.length`, name, a, b, aside, undefined, 1, label_at);
    });
  const wheel = file.wheel.radius * to.scale;
  const hub = rear[2]!;
  const out: Dimension[] = [
    ...leg(front, "front"),
    ...(file.rear?.thigh || file.rear?.calf
      ? leg(rear, "rear").filter((d) => file.rear?.[d.label as "thigh" | "calf"])
      : []),
    line(
      "wheel.radius",
      "wheel radius",
      [hub[0] + wheel, hub[1]],
      [hub[0], hub[1]],
      [0, wheel + 22],
      [-1, 0],
      1,
    ),
    line(
      "hips",
      narrow ? "hips" : "hip distance",
      rear[0]!,
      front[0]!,
      [0, top - rear[0]![1] - 26],
      [1, 0],
      2,
    ),
    line(
      "trunk.length",
      narrow ? "trunk" : "trunk length",
      [trunk[3]![0], trunk[3]![1]],
      [trunk[2]![0], trunk[2]![1]],
      [0, top - trunk[3]![1] - 56],
      [1, 0],
      2,
    ),
    line(
      "trunk.height",
      "trunk height",
      trunk[0]!,
      trunk[3]!,
      [back - trunk[0]![0] - TRUNK_HEIGHT, 0],
      [0, -1],
      2,
    ),
    line(
      "height",
      "standing",
      [left, ground],
      [left, to.py(file.nominal_height)],
      [-HEIGHT, 0],
      [0, -1],
      1,
      // Beside the wheel, where a narrow view has room for it.
      clearShare(
        narrow ? 0.16 : 0.4,
        Math.max(STANDING[0], left - HEIGHT),
        [ground, to.py(file.nominal_height)],
        bones,
        wheel,
        to,
      ),
    ),
  ];
  return narrow ? out.filter((d) => d.id !== "trunk.height") : out;
}

/** The share of an upright line nearest to `wanted` at which a label lies on no link or wheel. */
function clearShare(
  wanted: number,
  middle: number,
  [low, high]: [number, number],
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
    const y = low + (high - low) * share;
    const around = [-1, -0.5, 0, 0.5, 1].flatMap((k) =>
      [-1, 1].map((side): Vec2 => [middle + k * STANDING[0], y + side * STANDING[1]]),
    );
    return around.every((p) =>
      [...links, ...wheels].every(({ a, b, radius }) => distance(p, a, b) > radius),
    );
  };
  const all = Array.from({ length: 46 }, (_, k) => 0.1 + k * 0.02);
  const nearest = [wanted, ...all.sort((p, q) => Math.abs(p - wanted) - Math.abs(q - wanted))];
  return nearest.find(free) ?? wanted;
}
