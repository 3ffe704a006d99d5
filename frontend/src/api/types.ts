/**
 * The documents that the page reads. Generated from the service's OpenAPI (`npm run types`), with
 * pairs of numbers as pairs; what OpenAPI leaves open is written out here. SI units and radians.
 */

import type { components } from "./schema";

type Schemas = components["schemas"];

export type Vec2 = [number, number];

export type TerrainDocument = Omit<Schemas["Terrain"], "points" | "schema"> & {
  schema: string;
  points: Vec2[];
  readonly?: boolean;
};

/** Only what the page draws is looked at; the rest of the robot file passes through untouched. */
export type RobotDocument = Schemas["RobotDocument"];
/** As it is sent: without what the service adds. */
export type SentRobot = Omit<RobotDocument, "readonly" | "version">;
export type ImportedRobot = Schemas["Imported"];
export type Method = Schemas["PlanRequest"]["method"];
export type Facing = NonNullable<Schemas["Plan"]["facing"]>;
/** Which end of the robot shall lead; either: as the planner finds better. */
export type FacingChoice = NonNullable<Schemas["PlanRequest"]["facing"]>;
export type PlanTiming = NonNullable<Schemas["PlanRequest"]["timing"]>;
export type Margins = Schemas["Margins"];

export type Pose = Omit<
  Schemas["Pose"],
  "wheels" | "contacts" | "com" | "collision_points" | "forces"
> & {
  wheels: Vec2[];
  contacts: Vec2[];
  com: Vec2;
  collision_points: Vec2[];
  /** Static force of each wheel pair, tangential and normal [N]. */
  forces?: Vec2[] | null;
};

export type Problem = Omit<Schemas["Problem"], "at"> & { at: Vec2 };

export type Plan = Omit<Schemas["Plan"], "terrain" | "problem" | "certificate" | "poses"> & {
  terrain: TerrainDocument;
  problem?: Problem | null;
  certificate?: (Omit<Schemas["Certificate"], "motion"> & { motion?: Problem | null }) | null;
  poses: Pose[];
};

export type Outcome = Schemas["Rollout"]["outcome"];
export type Metrics = Schemas["Metrics"];
/** Speeds, torques and forces come with the end of a rollout. */
type AtTheEnd = "dq" | "torque" | "progress_desired" | "contact_force";
export type Series = Omit<Schemas["Series"], AtTheEnd> & Partial<Pick<Schemas["Series"], AtTheEnd>>;

/** What can be played: a rollout, or as much of it as there is yet. */
export interface Drive {
  outcome: Outcome | "running" | "cancelled";
  series: Series;
}

/** It is over, and not at its goal. */
export const hasFailed = (drive: Drive | null): boolean =>
  drive !== null && drive.outcome !== "success" && drive.outcome !== "running";

export type Rollout = Schemas["Rollout"];
export type Trials = Schemas["Trials"];
export type Trial = Schemas["Trial"];

export type Job = Omit<Schemas["JobDocument"], "error"> & { error: ProblemDetail | null };

export type MeshHeights = Omit<Schemas["MeshHeights"], "low" | "high"> & {
  low: [number, number, number];
  high: [number, number, number];
};

/** RFC 9457. */
export type ProblemDetail = Partial<Schemas["ProblemDocument"]>;

export type ExportFormat = Schemas["ExportFormat"];

export interface SettingSchema {
  title?: string;
  description?: string;
  type?: string | string[];
  /** Null where the robot or the plan decides. */
  default?: number | boolean | string | object | null;
  minimum?: number;
  maximum?: number;
  exclusiveMinimum?: number;
  exclusiveMaximum?: number;
  enum?: (string | number)[];
  unit?: string;
  symbol?: string;
  scale?: "log" | "linear";
  /** Range of a slider, where the bounds are much wider. */
  slider?: [number, number];
  /** Heading that it stands under. */
  group?: string;
  /** Of a record: its fields. */
  properties?: Record<string, SettingSchema>;
  /** A list of numbers, each with its own bounds, or nothing. */
  anyOf?: { type?: string; prefixItems?: SettingSchema[] }[];
  /** A number, or several: in a list, or in a record. */
  oneOf?: {
    type?: string;
    items?: SettingSchema;
    properties?: Record<string, SettingSchema>;
  }[];
  /** The only timing that this has an effect with. */
  timing?: PlanTiming;
}

export interface SettingsGroup {
  properties: Record<string, SettingSchema>;
}

export interface Settings {
  weights: Partial<Record<Method, SettingsGroup>>;
  tolerance: SettingsGroup;
  controller: SettingsGroup;
  disturbance: SettingsGroup;
  /** Deviations that trials draw from, by name. */
  bundles: Record<string, Schemas["Ranges"]>;
  exports: Record<"plan" | "rollout" | "robot", ExportFormat[]>;
}

export type SettingValue = number | boolean | string | readonly number[] | SettingValues;
/** Null goes back to the default. */
export type SettingChange = SettingValue | null;
export interface SettingValues {
  [name: string]: SettingValue;
}

export interface PlanRequest {
  terrain: TerrainDocument;
  robot: string | SentRobot;
  friction: number;
  method: Method;
  weights?: SettingValues;
  timing?: PlanTiming;
  facing?: FacingChoice;
  tolerance?: SettingValues;
}
