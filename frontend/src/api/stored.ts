/** Lists of stored plans, rollouts and sets of trials; what users note about them. */

import { call, callJson } from "./client";
import type { components } from "./schema";
import type {
  Facing,
  Margins,
  Method,
  Metrics,
  Outcome,
  Plan,
  PlanTiming,
  SettingValues,
  Vec2,
} from "./types";

export type Kind = "plans" | "rollouts" | "trials";

/** What a list tells of a result; results of older versions lack some of it. */
export interface Summary {
  terrain: string;
  robot: string;
  method?: Method;
  status?: Plan["status"];
  problem?: string | null;
  friction?: number;
  weights?: SettingValues;
  tolerance?: SettingValues;
  controller?: SettingValues;
  seed?: number;
  disturbance?: SettingValues;
  timing?: PlanTiming;
  facing?: Facing;
  margins?: Margins | null;
  /** [s] */
  duration?: number | null;
  /** Of the rollout; work per unit of weight and distance, without unit. */
  cost_of_transport?: number | null;
  /** Work of the plan's static torques, without losses [J]. */
  planned_energy?: number | null;
  planned_cost_of_transport?: number | null;
  outline?: Vec2[];
  pose?: { x: number; z: number; pitch: number; q: number[] } | null;
  plan_id?: string;
  outcome?: Outcome;
  reason?: string;
  metrics?: Metrics;
  bundle?: string | null;
  count?: number;
  successes?: number;
  /** Two-sided 95 %. */
  interval?: Vec2;
}

export type Entry = Omit<components["schemas"]["StoredEntry"], "summary"> & {
  kind: Kind;
  summary: Summary;
};
export type EntryChanges = Partial<Pick<Entry, "name" | "note" | "pinned">>;

/** One page of a list, newest first, and how many there are in all. */
export async function listStored(
  kind: Kind,
  query: { limit: number; offset: number; search?: string; pinned?: boolean },
): Promise<{ entries: Entry[]; total: number }> {
  const words = new URLSearchParams();
  for (const [name, value] of Object.entries(query)) {
    if (value !== undefined && value !== "") words.set(name, String(value));
  }
  const answer = await call("GET", `${kind}?${words}`);
  const entries = (await answer.json()) as Omit<Entry, "kind">[];
  return {
    entries: entries.map((entry) => ({ ...entry, kind })),
    total: Number(answer.headers.get("x-total-count") ?? entries.length),
  };
}

export const patchStored = async ({ kind, id }: Entry, changes: EntryChanges): Promise<Entry> => ({
  ...(await callJson<Omit<Entry, "kind">>("PATCH", `${kind}/${id}`, changes)),
  kind,
});
