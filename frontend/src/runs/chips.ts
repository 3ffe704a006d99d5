/** What differs from the defaults, in a few words each. */

import type { Entry } from "../api/stored";
import type { SettingSchema, SettingValue } from "../api/types";
import { fixed, setting } from "../geometry/format";
import { disturbanceSchema, settings } from "../state/setup";

const METHODS: Record<string, string> = {
  critical: "critical poses",
  nominal: "no pose optimisation",
};

const plain = (value: SettingValue) =>
  typeof value === "number" ? setting(value) : typeof value === "boolean" ? yes(value) : value;
const yes = (value: boolean) => (value ? "on" : "off");

function one(name: string, value: SettingValue, schema: SettingSchema | undefined): string {
  const unit = schema?.unit && schema.unit !== "1" ? ` ${schema.unit}` : "";
  const label = schema?.title ?? name.replaceAll("_", " ");
  return `${label} ${plain(value)}${unit}`;
}

function group(
  values: Record<string, SettingValue> | undefined,
  schema: Record<string, SettingSchema> | undefined,
): string[] {
  return Object.entries(values ?? {}).map(([name, value]) => one(name, value, schema?.[name]));
}

/** Friction first, then method, weights, tolerance, controller, disturbance, seed. */
export function chips({ summary: s }: Entry): string[] {
  const known = settings.value;
  return [
    ...(s.friction === undefined ? [] : [`μ ${fixed(s.friction, 2)}`]),
    ...(s.method && METHODS[s.method] ? [METHODS[s.method]!] : []),
    ...(s.bundle ? [`${s.bundle} disturbances`] : []),
    ...group(s.weights, s.method && known?.weights[s.method]?.properties),
    ...group(s.tolerance, known?.tolerance.properties),
    ...group(s.controller, known?.controller.properties),
    ...group(s.disturbance, disturbanceSchema.value),
    ...(s.seed ? [`seed ${s.seed}`] : []),
  ];
}
