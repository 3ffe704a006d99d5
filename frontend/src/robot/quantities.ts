/** Every number of a robot that can be seen and changed here: where it lies, its unit, its bounds. */

import type { RobotDocument } from "../api/types";
import { bigger, heavier, heights, longer, resized, standing } from "./stretch";

export type Group = "Geometry" | "Masses" | "Motors" | "Joint ranges";
export const GROUPS: readonly Group[] = ["Geometry", "Masses", "Motors", "Joint ranges"];

export interface Quantity {
  id: string;
  group: Group;
  label: string;
  unit: string;
  /** What is shown per SI unit. */
  factor: number;
  /** Decimals on screen. */
  digits: number;
  /** In SI units. */
  min: number;
  max: number;
  step: number;
  /** Null where this robot has no such number. */
  read: (file: RobotDocument) => number | null;
  write: (file: RobotDocument, value: number) => RobotDocument;
  /** Found in the sentences of `assumed` that speak of it. */
  words: RegExp;
}

type Write = Quantity["write"];
type Kind = Pick<Quantity, "unit" | "factor" | "digits" | "min" | "max" | "step">;

const METRES: Kind = { unit: "m", factor: 1, digits: 3, min: 0.01, max: 5, step: 0.001 };
const OFFSET: Kind = { unit: "mm", factor: 1000, digits: 0, min: -2, max: 2, step: 0.001 };
const MASS: Kind = { unit: "kg", factor: 1, digits: 2, min: 0.01, max: 500, step: 0.05 };
const TORQUE: Kind = { unit: "Nm", factor: 1, digits: 1, min: 0.1, max: 1000, step: 0.5 };
const SPEED: Kind = { unit: "rad/s", factor: 1, digits: 1, min: 0.1, max: 500, step: 0.5 };
const ROTOR: Kind = { unit: "kg m²", factor: 1, digits: 4, min: 0, max: 10, step: 0.001 };
const ANGLE: Kind = {
  unit: "°",
  factor: 180 / Math.PI,
  digits: 0,
  min: -5 * Math.PI,
  max: 5 * Math.PI,
  step: Math.PI / 180,
};

/** A document of the first schema says all that one of the second does. */
const latest = (file: RobotDocument): RobotDocument => ({ ...file, schema: "stairwright/robot/2" });

function quantity(
  id: string,
  group: Group,
  label: string,
  kind: Kind,
  words: RegExp,
  read: Quantity["read"],
  write: Write,
): Quantity {
  return { id, group, label, ...kind, words, read, write: (f, v) => standing(write(latest(f), v)) };
}

type End = "front" | "rear";
type LinkName = "thigh" | "calf";

function linkOf(file: RobotDocument, end: End, name: LinkName) {
  return end === "front" ? file[name] : (file.rear?.[name] ?? null);
}

function withLink(file: RobotDocument, end: End, name: LinkName, link: RobotDocument["thigh"]) {
  return end === "front"
    ? { ...file, [name]: link }
    : { ...file, rear: { ...file.rear, [name]: link } };
}

const capital = (word: string) => word[0]!.toUpperCase() + word.slice(1);

/** Rear links have rows of their own where they differ from the front ones. */
function linkRows(end: End, name: LinkName): Quantity[] {
  const label = end === "front" ? capital(name) : `Rear ${name}`;
  const words = new RegExp(`\\b${name}\\b.*\\b(length|mass)`, "i");
  return [
    quantity(
      `${end}.${name}.length`,
      "Geometry",
      label,
      METRES,
      words,
      (f) => linkOf(f, end, name)?.length ?? null,
      (f, v) => withLink(f, end, name, longer(linkOf(f, end, name)!, v)),
    ),
    quantity(
      `${end}.${name}.mass`,
      "Masses",
      label,
      MASS,
      words,
      (f) => linkOf(f, end, name)?.mass ?? null,
      (f, v) => withLink(f, end, name, heavier(linkOf(f, end, name)!, v)),
    ),
  ];
}

const LINKS = (["front", "rear"] as const).flatMap((end) =>
  (["thigh", "calf"] as const).flatMap((name) => linkRows(end, name)),
);

function wheels(
  file: RobotDocument,
  change: (w: RobotDocument["wheel"]) => RobotDocument["wheel"],
) {
  const rear = file.rear?.wheel;
  return {
    ...file,
    wheel: change(file.wheel),
    ...(rear ? { rear: { ...file.rear, wheel: change(rear) } } : {}),
  };
}

const GEOMETRY: Quantity[] = [
  quantity(
    "wheel.radius",
    "Geometry",
    "Wheel radius",
    METRES,
    /wheel.*radius|radius.*wheel/i,
    (f) => f.wheel.radius,
    (f, v) => wheels(f, (w) => bigger(w, v)),
  ),
  quantity(
    "wheel.width",
    "Geometry",
    "Wheel width",
    METRES,
    /wheel.*width|width.*wheel/i,
    (f) => f.wheel.width,
    (f, v) => wheels(f, (w) => ({ ...w, width: v })),
  ),
  quantity(
    "hips",
    "Geometry",
    "Hip distance",
    { ...METRES, min: 0.02 },
    /\bhip/i,
    (f) => f.hips.front[0]! - f.hips.rear[0]!,
    (f, v) => ({
      ...f,
      hips: { ...f.hips, front: [v / 2, f.hips.front[1]!], rear: [-v / 2, f.hips.rear[1]!] },
    }),
  ),
  quantity(
    "half_track",
    "Geometry",
    "Half track",
    METRES,
    /track/i,
    (f) => f.hips.half_track,
    (f, v) => ({ ...f, hips: { ...f.hips, half_track: v } }),
  ),
  ...(["length", "width", "height"] as const).map((name, axis) =>
    quantity(
      `trunk.${name}`,
      "Geometry",
      `Trunk ${name}`,
      METRES,
      /(trunk|body).*(size|box|shape)/i,
      (f) => f.trunk.size[axis]!,
      (f, v) => resized(f, axis as 0 | 1 | 2, v),
    ),
  ),
  quantity(
    "height",
    "Geometry",
    "Standing height",
    METRES,
    /height|stand/i,
    (f) => f.nominal_height,
    (f, v) => {
      const { least, most } = heights(f);
      return { ...f, nominal_height: Math.min(most, Math.max(least, v)) };
    },
  ),
];

const com = (file: RobotDocument) => file.trunk.com ?? [0, 0, 0];

function withCom(file: RobotDocument, axis: 0 | 2, value: number): RobotDocument {
  const place = com(file).map((v, i) => (i === axis ? value : v)) as [number, number, number];
  return { ...file, trunk: { ...file.trunk, com: place } };
}

/** Where a load goes that was nowhere before: on the trunk. */
const onTop = (file: RobotDocument): [number, number] => [0, 0.65 * file.trunk.size[2]!];

function withLoad(file: RobotDocument, mass: number): RobotDocument {
  const { payload, ...rest } = file;
  if (mass < MASS.min) return rest as RobotDocument;
  return { ...rest, payload: { mass, place: payload?.place ?? onTop(file) } } as RobotDocument;
}

function loadPlace(axis: 0 | 1, label: string): Quantity {
  return quantity(
    `payload.${axis === 0 ? "x" : "z"}`,
    "Masses",
    label,
    OFFSET,
    /payload|load/i,
    (f) => (f.payload ? (f.payload.place ?? [0, 0])[axis]! : null),
    (f, v) => {
      if (!f.payload) return f;
      const place = [...(f.payload.place ?? [0, 0])] as [number, number];
      place[axis] = v;
      return { ...f, payload: { ...f.payload, place } };
    },
  );
}

const MASSES: Quantity[] = [
  quantity(
    "trunk.mass",
    "Masses",
    "Trunk",
    MASS,
    /(trunk|body).*mass/i,
    (f) => f.trunk.mass,
    (f, v) => ({ ...f, trunk: heavier(f.trunk, v) }),
  ),
  quantity(
    "com.x",
    "Masses",
    "Trunk CoM, x",
    OFFSET,
    /\bcom\b|mass centre/i,
    (f) => com(f)[0]!,
    (f, v) => withCom(f, 0, v),
  ),
  quantity(
    "com.z",
    "Masses",
    "Trunk CoM, z",
    OFFSET,
    /\bcom\b|mass centre/i,
    (f) => com(f)[2]!,
    (f, v) => withCom(f, 2, v),
  ),
  quantity(
    "wheel.mass",
    "Masses",
    "Wheel",
    MASS,
    /wheel.*mass/i,
    (f) => f.wheel.mass,
    (f, v) => wheels(f, (w) => heavier(w, v)),
  ),
  quantity(
    "payload.mass",
    "Masses",
    "Payload",
    { ...MASS, min: 0, step: 0.5 },
    /payload|load/i,
    (f) => f.payload?.mass ?? 0,
    withLoad,
  ),
  loadPlace(0, "Payload, x"),
  loadPlace(1, "Payload, z"),
];

type MotorName = "leg" | "thigh" | "calf" | "wheel";
type MotorField = "torque" | "speed" | "armature";

const MOTORS: Quantity[] = (["leg", "thigh", "calf", "wheel"] as const).flatMap((name) =>
  (
    [
      ["torque", TORQUE, "torque", /torque/i],
      ["speed", SPEED, "top speed", /speed/i],
      ["armature", ROTOR, "rotor inertia", /rotor|armature/i],
    ] as const
  ).map(([field, kind, text, words]) => motorRow(name, field, kind, text, words)),
);

function motorRow(
  name: MotorName,
  field: MotorField,
  kind: Kind,
  text: string,
  words: RegExp,
): Quantity {
  const label = name === "leg" ? "Leg" : capital(name);
  return quantity(
    `${name}.${field}`,
    "Motors",
    `${label} ${text}`,
    kind,
    words,
    (f) => f.actuators[name]?.[field] ?? null,
    (f, v) => ({
      ...f,
      actuators: { ...f.actuators, [name]: { ...f.actuators[name]!, [field]: v } },
    }),
  );
}

/** A range keeps this much, so that its ends never meet [rad]. */
const LEAST_RANGE = 0.02;

function rangeEnd(end: End, joint: LinkName, side: 0 | 1): Quantity {
  return quantity(
    rangeId(end, joint, side),
    "Joint ranges",
    `${capital(end)} ${joint}, ${side === 0 ? "lower" : "upper"}`,
    ANGLE,
    /range|limit/i,
    (f) => f.joints[end][joint][side]!,
    (f, v) => {
      const range = [...f.joints[end][joint]] as [number, number];
      range[side] =
        side === 0 ? Math.min(v, range[1] - LEAST_RANGE) : Math.max(v, range[0] + LEAST_RANGE);
      const joints = { ...f.joints, [end]: { ...f.joints[end], [joint]: range } };
      return { ...f, joints };
    },
  );
}

export const rangeId = (end: End, joint: LinkName, side: 0 | 1) =>
  `${end}.${joint}.${side === 0 ? "low" : "high"}`;

const RANGES = (["front", "rear"] as const).flatMap((end) =>
  (["thigh", "calf"] as const).flatMap((joint) => [
    rangeEnd(end, joint, 0),
    rangeEnd(end, joint, 1),
  ]),
);

export const QUANTITIES: readonly Quantity[] = [
  ...LINKS,
  ...GEOMETRY,
  ...MASSES,
  ...MOTORS,
  ...RANGES,
];
const BY_ID = new Map(QUANTITIES.map((q) => [q.id, q]));

export function quantityOf(id: string): Quantity {
  const found = BY_ID.get(id);
  if (!found) throw new Error(`no quantity is called ${id}`);
  return found;
}

export const clamped = (q: Quantity, value: number) => Math.min(q.max, Math.max(q.min, value));

/** Whole mass, both sides [kg]. */
export function totalMass(file: RobotDocument): number {
  const leg = (rear: boolean) => {
    const own = rear ? file.rear : null;
    return [own?.thigh ?? file.thigh, own?.calf ?? file.calf, own?.wheel ?? file.wheel].reduce(
      (sum, part) => sum + part.mass,
      0,
    );
  };
  return file.trunk.mass + (file.payload?.mass ?? 0) + 2 * leg(false) + 2 * leg(true);
}
