/** The pose in which a robot is shown alone: wheels below the hips, knees to their sides. */

import type { RobotDocument, Vec2 } from "../api/types";
import type { Frame } from "./robot";

/** Knees that bend both ways point towards each other, as their makers stand them. */
const TOWARDS = [-1, 1] as const;

const limited = (value: number, [low, high]: readonly number[]) =>
  Math.min(high!, Math.max(low!, value));

export function kneeSide(calf: readonly number[], end: 0 | 1): 1 | -1 {
  if (calf[0]! < 0 && calf[1]! > 0) return TOWARDS[end];
  return calf[0]! + calf[1]! > 0 ? 1 : -1;
}

/** Thigh and calf angle that put the wheel at `d` from the hip; stretched where it is too far. */
function legAngles(thigh: number, calf: number, d: Vec2, knee: number): [number, number] {
  const square = d[0] ** 2 + d[1] ** 2;
  const cosine = (square - thigh ** 2 - calf ** 2) / (2 * thigh * calf);
  const bend = knee * Math.acos(Math.min(1, Math.max(-1, cosine)));
  const leg = Math.atan2(-d[0], -d[1]);
  return [leg - Math.atan2(calf * Math.sin(bend), thigh + calf * Math.cos(bend)), bend];
}

/** The robot on level ground at z = 0, its trunk's centre at x = 0. */
export function stance(file: RobotDocument): Frame {
  const ends = ["front", "rear"] as const;
  const q = ends.flatMap((end, i) => {
    const own = i === 1 ? file.rear : null;
    const { thigh, calf } = file.joints[end];
    const drop = file.nominal_height + file.hips[end][1]! - file.wheel.radius;
    const angles = legAngles(
      (own?.thigh ?? file.thigh).length,
      (own?.calf ?? file.calf).length,
      [0, -drop],
      kneeSide(calf, i as 0 | 1),
    );
    return [limited(angles[0], thigh), limited(angles[1], calf)];
  });
  return { x: 0, z: file.nominal_height, pitch: 0, q };
}
