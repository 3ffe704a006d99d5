/** Where the robot's points lie for a pose: only for drawing what the service answered. */

import type { RobotDocument, Vec2 } from "../api/types";

export interface RobotShape {
  name: string;
  trunk: { length: number; height: number };
  hips: [Vec2, Vec2];
  thigh: number;
  calf: number;
  wheel: number;
  /** Peak torques [Nm]. */
  limit: { leg: number; wheel: number };
  /** In trunk sizes from its centre, and as fractions of the links. */
  collisionPoints: { trunk: Vec2[]; thigh: number[]; calf: number[] };
}

/** Planar configuration: trunk point, pitch about +y, [front thigh, calf, rear thigh, calf]. */
export interface Frame {
  x: number;
  z: number;
  pitch: number;
  q: number[];
}

export interface Skeleton {
  trunk: Vec2[];
  /** Hip, knee and wheel centre of the front and the rear leg. */
  legs: [Vec2[], Vec2[]];
}

const pair = (v: readonly number[]): Vec2 => [v[0]!, v[1]!];

export function robotShape(file: RobotDocument): RobotShape {
  const { leg, thigh, calf, wheel } = file.actuators;
  const motors = [thigh ?? leg, calf ?? leg].flatMap((motor) => (motor ? [motor.torque] : []));
  return {
    name: file.name,
    trunk: { length: file.trunk.size[0]!, height: file.trunk.size[2]! },
    hips: [pair(file.hips.front), pair(file.hips.rear)],
    thigh: file.thigh.length,
    calf: file.calf.length,
    wheel: file.wheel.radius,
    limit: { leg: Math.min(...motors), wheel: wheel.torque },
    collisionPoints: {
      trunk: file.collision_points?.trunk.map(pair) ?? [],
      thigh: file.collision_points?.thigh ?? [],
      calf: file.collision_points?.calf ?? [],
    },
  };
}

/** A vector of the trunk frame in the world; pitch turns about +y, so nose-up is negative. */
function toWorld(frame: Frame, u: number, v: number): Vec2 {
  const c = Math.cos(frame.pitch);
  const s = Math.sin(frame.pitch);
  return [frame.x + u * c + v * s, frame.z - u * s + v * c];
}

function along(from: Vec2, length: number, angle: number): Vec2 {
  return [from[0] - length * Math.sin(angle), from[1] - length * Math.cos(angle)];
}

export function skeleton(robot: RobotShape, frame: Frame): Skeleton {
  const l = robot.trunk.length / 2;
  const h = robot.trunk.height / 2;
  const legs = robot.hips.map((offset, leg) => {
    const hip = toWorld(frame, offset[0], offset[1]);
    const thigh = frame.pitch + frame.q[2 * leg]!;
    const knee = along(hip, robot.thigh, thigh);
    return [hip, knee, along(knee, robot.calf, thigh + frame.q[2 * leg + 1]!)];
  });
  return {
    trunk: [
      toWorld(frame, -l, -h),
      toWorld(frame, l, -h),
      toWorld(frame, l, h),
      toWorld(frame, -l, h),
    ],
    legs: legs as [Vec2[], Vec2[]],
  };
}

export type Part = "trunk" | "front-thigh" | "front-calf" | "rear-thigh" | "rear-calf";

/** The part of the robot nearest to a point: the one to paint red. */
export function nearestPart(bones: Skeleton, at: Vec2): Part {
  const [front, rear] = bones.legs;
  const candidates: [Part, number][] = [
    ["front-thigh", distance(at, front[0]!, front[1]!)],
    ["front-calf", distance(at, front[1]!, front[2]!)],
    ["rear-thigh", distance(at, rear[0]!, rear[1]!)],
    ["rear-calf", distance(at, rear[1]!, rear[2]!)],
    [
      "trunk",
      Math.min(...bones.trunk.map((corner, i) => distance(at, corner, bones.trunk[(i + 1) % 4]!))),
    ],
  ];
  return candidates.reduce((best, next) => (next[1] < best[1] ? next : best))[0];
}

/** Distance of a point from a segment. */
export function distance(p: Vec2, a: Vec2, b: Vec2): number {
  const dx = b[0] - a[0];
  const dz = b[1] - a[1];
  const square = dx * dx + dz * dz;
  const along = square ? ((p[0] - a[0]) * dx + (p[1] - a[1]) * dz) / square : 0;
  const t = Math.min(1, Math.max(0, along));
  return Math.hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dz);
}
