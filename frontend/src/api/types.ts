/** The documents that the page reads, as the REST contract words them. SI units and radians. */

export type Vec2 = [number, number];

export interface TerrainDocument {
  schema: string;
  name: string;
  description: string;
  points: Vec2[];
  friction: number;
  start?: number | null;
  goal?: number | null;
  readonly?: boolean;
}

/** Only what the page draws; the rest of the robot file passes through untouched. */
export interface RobotDocument {
  name: string;
  description?: string;
  [field: string]: unknown;
}

export type Method = "path" | "critical" | "nominal";

export interface Margins {
  clearance: number;
  com: number;
  friction: number;
  torque: number;
}

export interface Pose {
  progress: number;
  time?: number;
  x_c: number;
  z_c: number;
  pitch: number;
  q: number[];
  wheels: Vec2[];
  wheel_progress: number[];
  contacts: Vec2[];
  com: Vec2;
  collision_points: Vec2[];
  margins: Margins;
}

export interface Problem {
  kind: string;
  at: Vec2;
  progress: number;
  message: string;
  limit?: { needed: number; available: number; quantity?: string; unit?: string } | null;
}

export interface Plan {
  schema: string;
  id: string;
  method: Method;
  terrain: TerrainDocument;
  robot: string;
  robot_description?: RobotDocument | null;
  friction: number;
  status: "feasible" | "infeasible";
  problem: Problem | null;
  poses: Pose[];
  critical: number[];
  timing: { total: number; [field: string]: unknown };
  solve_time: number;
  certificate?: Record<string, unknown> | null;
}

export type Outcome = "success" | "fell" | "stuck" | "collided" | "diverged" | "timeout";

export interface Metrics {
  duration: number;
  pitch_error_max: number;
  pitch_error_rms: number;
  joint_error_rms: number;
  torque_peak: number;
  wheel_torque_peak: number;
  energy: number;
  link_contacts: number;
  speed_mean: number;
  real_time_factor: number;
}

export interface Series {
  time: number[];
  base_position: number[][];
  base_quaternion: number[][];
  q: number[][];
  q_desired: number[][];
  dq: number[][];
  torque: number[][];
  pitch: number[];
  pitch_desired: number[];
  progress: number[];
  contact_force: number[][][];
}

export interface Rollout {
  schema: string;
  id: string;
  plan_id?: string;
  outcome: Outcome;
  seed?: number;
  reason?: string | null;
  metrics: Metrics;
  series: Series;
}

export type JobState = "queued" | "running" | "done" | "failed" | "cancelled";

export interface Job {
  id: string;
  state: JobState;
  progress: number;
  eta: number | null;
  result: string | null;
  error: ProblemDetail | null;
}

/** RFC 9457. */
export interface ProblemDetail {
  title?: string;
  status?: number;
  detail?: string;
  errors?: { field: string; message: string }[];
}

export interface SettingSchema {
  title?: string;
  description?: string;
  type?: string | string[];
  /** Null where the robot or the plan decides. */
  default?: number | boolean | string | null;
  minimum?: number;
  maximum?: number;
  exclusiveMinimum?: number;
  exclusiveMaximum?: number;
  enum?: (string | number)[];
  unit?: string;
  symbol?: string;
  scale?: "log" | "linear";
}

export interface SettingsGroup {
  properties: Record<string, SettingSchema>;
}

export interface Settings {
  weights: Partial<Record<Method, SettingsGroup>>;
  controller: SettingsGroup;
}

export type SettingValue = number | boolean | string;
/** Null goes back to the default. */
export type SettingChange = SettingValue | null;
export type SettingValues = Record<string, SettingValue>;

export interface PlanRequest {
  terrain: TerrainDocument;
  robot: string;
  friction: number;
  method: Method;
  weights?: SettingValues;
}
