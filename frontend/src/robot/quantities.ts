/** Every number of a robot that can be seen and changed here: where it lies, its unit, its bounds. */

import type { RobotDocument } from "../api/types";
import { capital } from "../geometry/format";
import { MASSES, wheels } from "./masses";
import { ANGLE, MASS, METRES, type Quantity, quantity, ROTOR, SPEED, TORQUE } from "./quantity";
import { bigger, heavier, heights, longer, resized } from "./stretch";

export { GROUPS, type Group, type Quantity } from "./quantity";

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

/** Rear links have rows of their own where they differ from the front ones. */
function linkRows(end: End, name: LinkName): Quantity[] {
  const label = end === "front" ? capital(name) : `Rear ${name}`;
  const path = end === "front" ? name : `rear.${name}`;
  return [
    quantity(`${end}.${name}.length`, "Geometry", label, METRES, `${path}.length`, (f, v) =>
      withLink(f, end, name, longer(linkOf(f, end, name)!, v)),
    ),
    quantity(`${end}.${name}.mass`, "Masses", label, MASS, `${path}.mass`, (f, v) =>
      withLink(f, end, name, heavier(linkOf(f, end, name)!, v)),
    ),
  ];
}

const LINKS = (["front", "rear"] as const).flatMap((end) =>
  (["thigh", "calf"] as const).flatMap((name) => linkRows(end, name)),
);

const GEOMETRY: Quantity[] = [
  quantity("wheel.radius", "Geometry", "Wheel radius", METRES, "wheel.radius", (f, v) =>
    wheels(f, (w) => bigger(w, v)),
  ),
  quantity("wheel.width", "Geometry", "Wheel width", METRES, "wheel.width", (f, v) =>
    wheels(f, (w) => ({ ...w, width: v })),
  ),
  quantity(
    "hips",
    "Geometry",
    "Hip distance",
    { ...METRES, min: 0.02 },
    "hips.front",
    (f, v) => ({
      ...f,
      hips: { ...f.hips, front: [v / 2, f.hips.front[1]!], rear: [-v / 2, f.hips.rear[1]!] },
    }),
    (f) => f.hips.front[0]! - f.hips.rear[0]!,
  ),
  quantity("half_track", "Geometry", "Half track", METRES, "hips.half_track", (f, v) => ({
    ...f,
    hips: { ...f.hips, half_track: v },
  })),
  ...(["length", "width", "height"] as const).map((name, axis) =>
    quantity(
      `trunk.${name}`,
      "Geometry",
      `Trunk ${name}`,
      METRES,
      "trunk.size",
      (f, v) => resized(f, axis as 0 | 1 | 2, v),
      (f) => f.trunk.size[axis]!,
    ),
  ),
  quantity("height", "Geometry", "Standing height", METRES, "nominal_height", (f, v) => {
    const { least, most } = heights(f);
    return { ...f, nominal_height: Math.min(most, Math.max(least, v)) };
  }),
];

const MOTORS: Quantity[] = (["leg", "thigh", "calf", "wheel"] as const).flatMap((name) =>
  (
    [
      ["torque", TORQUE, "torque"],
      ["speed", SPEED, "top speed"],
      ["armature", ROTOR, "rotor inertia"],
    ] as const
  ).map(([field, kind, text]) =>
    quantity(
      `${name}.${field}`,
      "Motors",
      `${capital(name)} ${text}`,
      kind,
      `actuators.${name}.${field}`,
      (f, v) => ({
        ...f,
        actuators: { ...f.actuators, [name]: { ...f.actuators[name]!, [field]: v } },
      }),
    ),
  ),
);

/** A range keeps this much, so that its ends never meet [rad]. */
const LEAST_RANGE = 0.02;

function rangeEnd(end: End, joint: LinkName, side: 0 | 1): Quantity {
  return quantity(
    rangeId(end, joint, side),
    "Joint ranges",
    `${capital(end)} ${joint}, ${side === 0 ? "lower" : "upper"}`,
    ANGLE,
    `joints.${end}.${joint}`,
    (f, v) => {
      const range = [...f.joints[end][joint]] as [number, number];
      range[side] =
        side === 0 ? Math.min(v, range[1] - LEAST_RANGE) : Math.max(v, range[0] + LEAST_RANGE);
      const joints = { ...f.joints, [end]: { ...f.joints[end], [joint]: range } };
      return { ...f, joints };
    },
    (f) => f.joints[end][joint][side]!,
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
