/** What the drawing is planned with: robot, method, weights, controller; and what there is. */

import { batch, computed, signal } from "@preact/signals";
import type {
  Facing,
  FacingChoice,
  ImportedRobot,
  Method,
  PlanTiming,
  RobotDocument,
  SentRobot,
  SettingChange,
  SettingSchema,
  Settings,
  SettingValues,
  TerrainDocument,
} from "../api/types";
import { type RobotShape, robotShape, turned } from "../geometry/robot";

export const terrains = signal<TerrainDocument[]>([]);
export const robots = signal<RobotDocument[]>([]);
export const settings = signal<Settings | null>(null);

export const robotName = signal("a1_wheeled_x");
export const method = signal<Method>("path");
/** How a path is timed: within limits of speed, or as fast as its dynamics allow. */
export const timing = signal<PlanTiming>("steady");
/** Which end of the robot shall lead, where that was said. */
export const chosenFacing = signal<FacingChoice | null>(null);
/** Which end leads where nothing is said, as the service has it. */
export const usualFacing = (by: PlanTiming = "steady"): FacingChoice =>
  by === "fast" ? "either" : "forward";
const usual = computed(() => usualFacing(method.value === "path" ? timing.value : "steady"));
/** What is asked for. */
export const facing = computed(() => chosenFacing.value ?? usual.value);
export const compare = signal(false);
export const seed = signal(0);
/** Only what differs from the default, by method. */
export const weights = signal<Partial<Record<Method, SettingValues>>>({});
/** How far the world may be from what is drawn, with the plan's certificate holding: not 0. */
export const tolerance = signal<SettingValues>({});
export const controller = signal<SettingValues>({});
/** How the real world differs from what plan and controller believe: only what is not 0. */
export const disturbance = signal<SettingValues>({});

/** Robots that were changed or imported and are not saved as they are now, by name. */
export const robotEdits = signal<Readonly<Record<string, RobotDocument>>>({});
/** Robots of names that are not stored: read from files, of links and of results. */
export const unsavedRobots = computed<RobotDocument[]>(() => {
  const names = new Set(robots.value.map((r) => r.name));
  return Object.values(robotEdits.value).filter((r) => !names.has(r.name));
});
/** Stored robots as they are now, then those that are not. */
export const allRobots = computed<RobotDocument[]>(() => [
  ...robots.value.map((r) => robotEdits.value[r.name] ?? r),
  ...unsavedRobots.value,
]);
/** The robot as it is stored; null for one that never was. */
export const storedRobot = computed(
  () => robots.value.find((r) => r.name === robotName.value) ?? null,
);
/** The robot that is planned with. */
export const robotDocument = computed<RobotDocument | null>(
  () => robotEdits.value[robotName.value] ?? storedRobot.value ?? robots.value[0] ?? null,
);
/** What a question says of it: its name, or all of it where no name stands for that. */
export const robotSource = computed(() => sourceOf(robotName.value, robotEdits.value));

export function sourceOf(name: string, edits: typeof robotEdits.value): string | SentRobot {
  const edited = edits[name];
  return edited ? sentRobot(edited) : name;
}

export function sentRobot(document: RobotDocument): SentRobot {
  const { readonly: _, version: __, ...sent } = document;
  return sent;
}

/** A robot that is not stored, as those are that are. */
export const asDocument = (robot: ImportedRobot["robot"] | SentRobot): RobotDocument =>
  ({ ...robot, readonly: false, version: "" }) as RobotDocument;

/** As its file has it. */
export const robotAsBuilt = computed<RobotShape | null>(() =>
  robotDocument.value ? robotShape(robotDocument.value) : null,
);
/** As plans have it, by the end that leads: that one is its front. */
export const robotFacing = computed<Record<Facing, RobotShape> | null>(() => {
  const forward = robotAsBuilt.value;
  return forward && { forward, backward: turned(forward) };
});

/** Some weights belong to one kind of timing alone. */
export const weightSchema = computed<Record<string, SettingSchema>>(() =>
  Object.fromEntries(
    Object.entries(settings.value?.weights[method.value]?.properties ?? {}).filter(
      ([, { timing: only }]) => !only || only === timing.value,
    ),
  ),
);
export const controllerSchema = computed<Record<string, SettingSchema>>(
  () => settings.value?.controller.properties ?? {},
);
export const disturbanceSchema = computed<Record<string, SettingSchema>>(
  () => settings.value?.disturbance.properties ?? {},
);
export const toleranceSchema = computed<Record<string, SettingSchema>>(
  () => settings.value?.tolerance.properties ?? {},
);
/** Those that have a say; of another timing they are kept. */
export const changedWeights = computed<SettingValues>(() =>
  Object.fromEntries(
    Object.entries(weights.value[method.value] ?? {}).filter(
      ([name]) => name in weightSchema.value,
    ),
  ),
);
export const changedCount = computed(() =>
  [changedWeights, controller, ...(method.value === "path" ? [tolerance] : [])].reduce(
    (sum, each) => sum + Object.keys(each.value).length,
    0,
  ),
);

/** Those that differ from their defaults: all that the inspector holds. */
export function differing(
  values: Record<string, unknown>,
  schema: Record<string, SettingSchema> = {},
): SettingValues {
  const kept = Object.entries(values).filter(
    ([name, value]) => value !== null && name in schema && schema[name]!.default !== value,
  );
  return Object.fromEntries(kept) as SettingValues;
}

/** The weights of a method as a result was asked with. */
export function takeWeights(by: Method, values: Record<string, unknown>): void {
  const schema = settings.peek()?.weights[by]?.properties;
  weights.value = { ...weights.peek(), [by]: differing(values, schema) };
}

/** With one of them set, or taken out where it is the default. */
export function withValue(
  values: SettingValues,
  schema: SettingSchema | undefined,
  name: string,
  value: SettingChange,
): SettingValues {
  const { [name]: _, ...rest } = values;
  return value === null || value === schema?.default ? rest : { ...rest, [name]: value };
}

export function setFacing(next: FacingChoice): void {
  chosenFacing.value = next === usual.peek() ? null : next;
}

export function setWeight(name: string, value: SettingChange): void {
  const all = weights.peek()[method.peek()] ?? {};
  const next = withValue(all, weightSchema.peek()[name], name, value);
  weights.value = { ...weights.peek(), [method.peek()]: next };
}

export function setTolerance(name: string, value: SettingChange): void {
  tolerance.value = withValue(tolerance.peek(), toleranceSchema.peek()[name], name, value);
}

export function setController(name: string, value: SettingChange): void {
  controller.value = withValue(controller.peek(), controllerSchema.peek()[name], name, value);
}

export function setDisturbance(name: string, value: SettingChange): void {
  disturbance.value = withValue(disturbance.peek(), disturbanceSchema.peek()[name], name, value);
}

const CHOSEN = {
  robotName,
  robotEdits,
  method,
  timing,
  chosenFacing,
  seed,
  weights,
  tolerance,
  controller,
  disturbance,
};
type Chosen = typeof CHOSEN;
export type Choices = { [Name in keyof Chosen]: Chosen[Name]["value"] };

/** All that undo brings back besides the drawing. */
export const choices = computed(
  () =>
    Object.fromEntries(Object.entries(CHOSEN).map(([name, { value }]) => [name, value])) as Choices,
);

export function choose(again: Choices): void {
  batch(() => {
    for (const [name, each] of Object.entries(CHOSEN)) each.value = again[name as keyof Chosen];
  });
}

export function resetAll(): void {
  weights.value = { ...weights.peek(), [method.peek()]: {} };
  tolerance.value = {};
  controller.value = {};
}
