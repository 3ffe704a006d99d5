/** Where the robot's points lie for a pose: only for drawing what the service answered. */

import type { SentRobot, Vec2 } from "../api/types";

/** A bar with round ends, in the frame of its link [m]. */
export interface Capsule {
  from: Vec2;
  to: Vec2;
  radius: number;
}

export interface LinkShape {
  length: number;
  /** One straight bar from joint to joint, or what a bent link is made of. */
  capsules: Capsule[];
}

export interface LegShape {
  /** In the trunk frame. */
  hip: Vec2;
  thigh: LinkShape;
  calf: LinkShape;
}

/** Peak torques [Nm]. */
export interface MotorLimits {
  thigh: number;
  calf: number;
  wheel: number;
}

export interface RobotShape {
  name: string;
  trunk: { length: number; height: number };
  /** Convex pieces of the trunk, in its frame. */
  outline: Vec2[][];
  payload: { mass: number; place: Vec2 } | null;
  /** Front and rear. */
  legs: [LegShape, LegShape];
  wheel: number;
  /** Of the front and the rear legs' motors. */
  limits: [MotorLimits, MotorLimits];
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
  /** Corners of the box. */
  trunk: Vec2[];
  /** What the trunk really looks like: its convex pieces. */
  outline: Vec2[][];
  payload: Vec2[] | null;
  /** Hip, knee and wheel centre of the front and the rear leg. */
  legs: [Vec2[], Vec2[]];
  /** The bars of each leg. */
  bars: [Bar[], Bar[]];
}

export interface Bar extends Capsule {
  link: "thigh" | "calf";
}

const pair = (v: readonly number[]): Vec2 => [v[0]!, v[1]!];

/** Of a robot whose file names none, as in the service. */
const STANDARD_POINTS: RobotShape["collisionPoints"] = {
  trunk: [
    ...[-0.5, -0.25, 0, 0.25, 0.5].map((x): Vec2 => [x, -0.5]),
    [-0.5, 0.5],
    [0.5, 0.5],
    [-0.5, 0],
    [0.5, 0],
  ],
  thigh: [0.25, 0.5, 0.75, 1],
  calf: [0.2, 0.4, 0.6, 0.8],
};

export function robotShape(file: SentRobot): RobotShape {
  const size: Vec2 = [file.trunk.size[0]!, file.trunk.size[2]!];
  const outline = (file.trunk.outline ?? []).map((piece) => piece.points.map(pair));
  const rear = file.rear;
  const load = file.payload;
  return {
    name: file.name,
    trunk: { length: size[0], height: size[1] },
    outline: outline.length > 0 ? outline : [box([0, 0], size)],
    payload: load ? { mass: load.mass, place: pair(load.place ?? [0, 0]) } : null,
    legs: [
      { hip: pair(file.hips.front), thigh: linkShape(file.thigh), calf: linkShape(file.calf) },
      {
        hip: pair(file.hips.rear),
        thigh: linkShape(rear?.thigh ?? file.thigh),
        calf: linkShape(rear?.calf ?? file.calf),
      },
    ],
    wheel: file.wheel.radius,
    limits: [limitsOf(file.actuators), limitsOf(rear?.actuators ?? file.actuators)],
    collisionPoints: pointsOf(file, outline.flat(), size),
  };
}

/** The robot turned about: its rear leads, as plans that face backward have it. */
export function turned(shape: RobotShape): RobotShape {
  const flip = ([x, z]: Vec2): Vec2 => [-x, z];
  const link = ({ length, capsules }: LinkShape): LinkShape => ({
    length,
    capsules: capsules.map((c) => ({ ...c, from: flip(c.from), to: flip(c.to) })),
  });
  const leg = ({ hip, thigh, calf }: LegShape): LegShape => ({
    hip: flip(hip),
    thigh: link(thigh),
    calf: link(calf),
  });
  const { legs, limits, payload, collisionPoints: points } = shape;
  return {
    ...shape,
    outline: shape.outline.map((piece) => piece.map(flip)),
    payload: payload && { ...payload, place: flip(payload.place) },
    legs: [leg(legs[1]), leg(legs[0])],
    limits: [limits[1], limits[0]],
    collisionPoints: { ...points, trunk: points.trunk.map(flip) },
  };
}

function linkShape(link: SentRobot["thigh"]): LinkShape {
  const { length, radius } = link;
  const shape = link.shape ?? [];
  return {
    length,
    capsules:
      shape.length > 0
        ? shape.map((c) => ({ from: pair(c.start), to: pair(c.end), radius: c.radius }))
        : [{ from: [0, 0], to: [0, -length], radius }],
  };
}

/** Where the service puts them: the paper's 25, and the corners of a trunk beyond its box. */
function pointsOf(file: SentRobot, corners: Vec2[], size: Vec2) {
  const own = file.collision_points;
  if (own) return { trunk: own.trunk.map(pair), thigh: own.thigh, calf: own.calf };
  const beyond = corners
    .map(([x, z]): Vec2 => [x / size[0], z / size[1]])
    .filter((p) => Math.max(Math.abs(p[0]), Math.abs(p[1])) > 0.5 + 1e-9);
  return { ...STANDARD_POINTS, trunk: [...STANDARD_POINTS.trunk, ...beyond] };
}

function box(centre: Vec2, size: Vec2): Vec2[] {
  const [x, z] = centre;
  const [l, h] = [size[0] / 2, size[1] / 2];
  return [
    [x - l, z - h],
    [x + l, z - h],
    [x + l, z + h],
    [x - l, z + h],
  ];
}

/** A load has no shape in the file: a flat box on its place, as large as a heavy one may be. */
function loadBox(robot: RobotShape): Vec2[] | null {
  if (!robot.payload) return null;
  const size: Vec2 = [0.45 * robot.trunk.length, 0.25 * robot.trunk.height];
  return box(robot.payload.place, size);
}

/** What the motors of thighs and calves can give [Nm]: each limit that differs. */
export const legLimits = (limits: RobotShape["limits"]): number[] => [
  ...new Set(limits.flatMap(({ thigh, calf }) => [thigh, calf])),
];

function limitsOf({ leg, thigh, calf, wheel }: SentRobot["actuators"]): MotorLimits {
  return {
    thigh: (thigh ?? leg)?.torque ?? Number.POSITIVE_INFINITY,
    calf: (calf ?? leg)?.torque ?? Number.POSITIVE_INFINITY,
    wheel: wheel.torque,
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

/** A point of a link's frame, whose origin is its upper joint and which hangs down at angle 0. */
function onLink(joint: Vec2, angle: number, [u, v]: Vec2): Vec2 {
  const c = Math.cos(angle);
  const s = Math.sin(angle);
  return [joint[0] + c * u + s * v, joint[1] - s * u + c * v];
}

function bars(link: "thigh" | "calf", shape: LinkShape, joint: Vec2, angle: number): Bar[] {
  return shape.capsules.map(({ from, to, radius }) => ({
    link,
    radius,
    from: onLink(joint, angle, from),
    to: onLink(joint, angle, to),
  }));
}

export function skeleton(robot: RobotShape, frame: Frame): Skeleton {
  const place = ([u, v]: Vec2) => toWorld(frame, u, v);
  const legs = robot.legs.map((leg, i) => {
    const hip = place(leg.hip);
    const thigh = frame.pitch + frame.q[2 * i]!;
    const calf = thigh + frame.q[2 * i + 1]!;
    const knee = along(hip, leg.thigh.length, thigh);
    return {
      joints: [hip, knee, along(knee, leg.calf.length, calf)],
      bars: [...bars("thigh", leg.thigh, hip, thigh), ...bars("calf", leg.calf, knee, calf)],
    };
  });
  const [front, rear] = legs;
  return {
    trunk: box([0, 0], [robot.trunk.length, robot.trunk.height]).map(place),
    outline: robot.outline.map((piece) => piece.map(place)),
    payload: loadBox(robot)?.map(place) ?? null,
    legs: [front!.joints, rear!.joints],
    bars: [front!.bars, rear!.bars],
  };
}

export type Part = "trunk" | "front-thigh" | "front-calf" | "rear-thigh" | "rear-calf";

/** The part of the robot nearest to a point: the one to paint red. */
export function nearestPart(bones: Skeleton, at: Vec2): Part {
  const candidates = bones.bars.flatMap((leg, i) =>
    leg.map((bar): [Part, number] => [
      `${i === 0 ? "front" : "rear"}-${bar.link}`,
      distance(at, bar.from, bar.to) - bar.radius,
    ]),
  );
  for (const piece of bones.outline) {
    const sides = piece.map((corner, i) => distance(at, corner, piece[(i + 1) % piece.length]!));
    candidates.push(["trunk", Math.min(...sides)]);
  }
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
