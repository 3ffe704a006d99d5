/** What a number of a robot is: its place in the file, its unit, its bounds. */

import type { RobotDocument } from "../api/types";
import { standing } from "./stretch";

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
  /** Of its field in the robot's document. */
  path: string;
}

type Write = Quantity["write"];
export type Kind = Pick<Quantity, "unit" | "factor" | "digits" | "min" | "max" | "step">;

export const METRES: Kind = { unit: "m", factor: 1, digits: 3, min: 0.01, max: 5, step: 0.001 };
export const OFFSET: Kind = { unit: "mm", factor: 1000, digits: 0, min: -2, max: 2, step: 0.001 };
export const MASS: Kind = { unit: "kg", factor: 1, digits: 2, min: 0.01, max: 500, step: 0.05 };
export const TORQUE: Kind = { unit: "Nm", factor: 1, digits: 1, min: 0.1, max: 1000, step: 0.5 };
export const SPEED: Kind = { unit: "rad/s", factor: 1, digits: 1, min: 0.1, max: 500, step: 0.5 };
export const ROTOR: Kind = { unit: "kg m²", factor: 1, digits: 4, min: 0, max: 10, step: 0.001 };
export const ANGLE: Kind = {
  unit: "°",
  factor: 180 / Math.PI,
  digits: 0,
  min: -5 * Math.PI,
  max: 5 * Math.PI,
  step: Math.PI / 180,
};

/** A document of the first schema says all that one of the second does. */
const latest = (file: RobotDocument): RobotDocument => ({ ...file, schema: "stairwright/robot/2" });

/** A number of a robot's document by its path, such as `calf.length`; null where there is none. */
export function numberAt(file: unknown, path: string): number | null {
  let at: unknown = file;
  for (const part of path.split(".")) {
    at = at && typeof at === "object" ? (at as Record<string, unknown>)[part] : undefined;
  }
  return typeof at === "number" ? at : null;
}

/** One number; writing it keeps the robot on its feet. */
export function quantity(
  id: string,
  group: Group,
  label: string,
  kind: Kind,
  path: string,
  write: Write,
  read: Quantity["read"] = (file) => numberAt(file, path),
): Quantity {
  return { id, group, label, ...kind, path, read, write: (f, v) => standing(write(latest(f), v)) };
}
