/** What the drawing is planned with: robot, method, weights, controller; and what there is. */

import { batch, computed, signal } from "@preact/signals";
import type {
  Method,
  RobotDocument,
  SettingChange,
  SettingSchema,
  Settings,
  SettingValues,
  TerrainDocument,
} from "../api/types";
import { type RobotShape, robotShape } from "../geometry/robot";

export const terrains = signal<TerrainDocument[]>([]);
export const robots = signal<RobotDocument[]>([]);
export const settings = signal<Settings | null>(null);

export const robotName = signal("a1_wheeled_x");
export const method = signal<Method>("path");
export const compare = signal(false);
export const seed = signal(0);
/** Only what differs from the default, by method. */
export const weights = signal<Partial<Record<Method, SettingValues>>>({});
export const controller = signal<SettingValues>({});
/** How the real world differs from what plan and controller believe: only what is not 0. */
export const disturbance = signal<SettingValues>({});

export const robot = computed<RobotShape | null>(() => {
  const document = robots.value.find((r) => r.name === robotName.value) ?? robots.value[0];
  return document ? robotShape(document) : null;
});

export const weightSchema = computed<Record<string, SettingSchema>>(
  () => settings.value?.weights[method.value]?.properties ?? {},
);
export const controllerSchema = computed<Record<string, SettingSchema>>(
  () => settings.value?.controller.properties ?? {},
);
export const disturbanceSchema = computed<Record<string, SettingSchema>>(
  () => settings.value?.disturbance.properties ?? {},
);
export const changedWeights = computed(() => weights.value[method.value] ?? {});
export const changedCount = computed(
  () => Object.keys(changedWeights.value).length + Object.keys(controller.value).length,
);

function withValue(
  values: SettingValues,
  schema: SettingSchema | undefined,
  name: string,
  value: SettingChange,
): SettingValues {
  const { [name]: _, ...rest } = values;
  return value === null || value === schema?.default ? rest : { ...rest, [name]: value };
}

export function setWeight(name: string, value: SettingChange): void {
  const next = withValue(changedWeights.peek(), weightSchema.peek()[name], name, value);
  weights.value = { ...weights.peek(), [method.peek()]: next };
}

export function setController(name: string, value: SettingChange): void {
  controller.value = withValue(controller.peek(), controllerSchema.peek()[name], name, value);
}

export function setDisturbance(name: string, value: SettingChange): void {
  disturbance.value = withValue(disturbance.peek(), disturbanceSchema.peek()[name], name, value);
}

/** All that undo brings back besides the drawing. */
export const choices = computed(() => ({
  robotName: robotName.value,
  method: method.value,
  seed: seed.value,
  weights: weights.value,
  controller: controller.value,
  disturbance: disturbance.value,
}));
export type Choices = typeof choices.value;

export function choose(again: Choices): void {
  batch(() => {
    robotName.value = again.robotName;
    method.value = again.method;
    seed.value = again.seed;
    weights.value = again.weights;
    controller.value = again.controller;
    disturbance.value = again.disturbance;
  });
}

export function resetAll(): void {
  weights.value = { ...weights.peek(), [method.peek()]: {} };
  controller.value = {};
}
