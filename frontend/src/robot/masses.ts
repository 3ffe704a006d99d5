/** Masses of a robot without its links: trunk, wheels, payload. */

import type { RobotDocument } from "../api/types";
import { MASS, OFFSET, type Quantity, quantity } from "./quantity";
import { heavier } from "./stretch";

/** Both ends' wheels, where the rear ones are others. */
export function wheels(
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
    "payload.place",
    (f, v) => {
      if (!f.payload) return f;
      const place = [...(f.payload.place ?? [0, 0])] as [number, number];
      place[axis] = v;
      return { ...f, payload: { ...f.payload, place } };
    },
    (f) => (f.payload ? (f.payload.place ?? [0, 0])[axis]! : null),
  );
}

export const MASSES: Quantity[] = [
  quantity("trunk.mass", "Masses", "Trunk", MASS, "trunk.mass", (f, v) => ({
    ...f,
    trunk: heavier(f.trunk, v),
  })),
  quantity(
    "com.x",
    "Masses",
    "Trunk CoM, x",
    OFFSET,
    "trunk.com",
    (f, v) => withCom(f, 0, v),
    (f) => com(f)[0]!,
  ),
  quantity(
    "com.z",
    "Masses",
    "Trunk CoM, z",
    OFFSET,
    "trunk.com",
    (f, v) => withCom(f, 2, v),
    (f) => com(f)[2]!,
  ),
  quantity("wheel.mass", "Masses", "Wheel", MASS, "wheel.mass", (f, v) =>
    wheels(f, (w) => heavier(w, v)),
  ),
  quantity(
    "payload.mass",
    "Masses",
    "Payload",
    { ...MASS, min: 0, step: 0.5 },
    "payload.mass",
    withLoad,
    (f) => f.payload?.mass ?? 0,
  ),
  loadPlace(0, "Payload, x"),
  loadPlace(1, "Payload, z"),
];
