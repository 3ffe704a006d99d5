/** Settings in the units of a screen: degrees and millimetres; files and interfaces have SI. */

import type { SettingSchema } from "../api/types";
import { setting } from "./format";

interface ScreenUnit {
  unit: string;
  /** Times what the interface has. */
  factor: number;
}

/** Lengths [m] and times [s] that stay below these are read in thousandths. */
const SHORT: Readonly<Record<string, number>> = { m: 0.2, s: 0.1 };

export function screenUnit(schema: SettingSchema | undefined): ScreenUnit {
  const unit = schema?.unit ?? "1";
  if (unit === "rad") return { unit: "°", factor: 180 / Math.PI };
  const most = schema?.maximum ?? schema?.exclusiveMaximum ?? Number.POSITIVE_INFINITY;
  if (most <= (SHORT[unit] ?? 0)) return { unit: `m${unit}`, factor: 1000 };
  // A ratio is a number without a unit.
  return { unit: unit === "1" ? "" : unit, factor: 1 };
}

/** A value with its unit, as it is read on screen. */
export function withUnit(value: number, schema: SettingSchema | undefined, signed = false): string {
  const { unit, factor } = screenUnit(schema);
  const sign = signed && value > 0 ? "+" : "";
  return `${sign}${setting(value * factor)}${unit === "°" ? "°" : unit ? ` ${unit}` : ""}`;
}
