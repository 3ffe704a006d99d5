/** What differs from the defaults, in a few words each. */

import type { Entry } from "../api/stored";
import type { SettingSchema, SettingValue, SettingValues } from "../api/types";
import { fixed, setting } from "../geometry/format";
import { screenUnit, withUnit } from "../geometry/units";
import { disturbanceSchema, settings } from "../state/setup";

const METHODS: Record<string, string> = {
  critical: "critical poses",
  nominal: "no pose optimisation",
};

const PLACE = { title: "Place", unit: "m", maximum: 0.2 };

/** Numbers of a list with one unit, a record field by field, and the rest as it is. */
function words(value: SettingValue, schema: SettingSchema | undefined, signed: boolean): string {
  if (typeof value === "number") return withUnit(value, schema, signed);
  if (typeof value === "boolean") return value ? "on" : "off";
  if (typeof value === "string") return value;
  if (Array.isArray(value)) {
    const { unit, factor } = screenUnit(schema);
    return `${value.map((each) => setting(each * factor)).join(", ")} ${unit}`.trim();
  }
  if ("mass" in value) {
    const { mass, place } = value as SettingValues;
    return `${words(mass!, schema, signed)} at ${words(place ?? "the top", PLACE, signed)}`;
  }
  return group(value as SettingValues, schema?.properties, signed).join(", ");
}

function group(
  values: Record<string, SettingValue> | undefined,
  schema: Record<string, SettingSchema> | undefined,
  signed = false,
): string[] {
  return Object.entries(values ?? {}).map(([name, value]) => {
    const label = schema?.[name]?.title ?? name.replaceAll("_", " ");
    return `${label} ${words(value, schema?.[name], signed)}`;
  });
}

/** Friction first, then method, timing, weights, tolerance, controller, disturbance, seed. */
export function chips({ summary: s }: Entry): string[] {
  const known = settings.value;
  return [
    ...(s.friction === undefined ? [] : [`μ ${fixed(s.friction, 2)}`]),
    ...(s.method && METHODS[s.method] ? [METHODS[s.method]!] : []),
    ...(s.timing === "fast" ? ["fast"] : []),
    ...(s.facing === "backward" ? ["backward"] : []),
    ...(s.bundle ? [`${s.bundle} disturbances`] : []),
    ...group(s.weights, s.method && known?.weights[s.method]?.properties),
    ...group(s.tolerance, known?.tolerance.properties),
    ...group(s.controller, known?.controller.properties),
    ...group(s.disturbance, disturbanceSchema.value, true),
    ...(s.seed ? [`seed ${s.seed}`] : []),
  ];
}
