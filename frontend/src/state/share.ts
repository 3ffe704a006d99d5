/** The address: `#s=` and the state, enough to see the same page elsewhere; `v=` the workspace. */

import { effect } from "@preact/signals";
import type { Method, SettingValues, TerrainDocument, Vec2 } from "../api/types";
import { committed, isEmpty, open, origin, terrainDocument } from "./drawing";
import { run, runB, runStale } from "./rollouts";
import {
  compare,
  controller,
  disturbance,
  method,
  robotName,
  seed,
  terrains,
  weights,
} from "./setup";
import { toast } from "./toast";
import { workspace } from "./workspace";

/** Short keys: the whole of this stands in the link. */
interface Shared {
  t: Omit<TerrainDocument, "schema">;
  r: string;
  m: Method;
  w?: Partial<Record<Method, SettingValues>>;
  c?: SettingValues;
  s?: number;
  /** Disturbance. */
  d?: SettingValues;
  ab?: 1;
  /** Rollouts A and B, as ids. */
  ro?: string;
  rb?: string;
}

function encode(state: Shared): string {
  const bytes = new TextEncoder().encode(JSON.stringify(state));
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
}

function decode(text: string): Shared {
  const binary = atob(text.replace(/-/g, "+").replace(/_/g, "/"));
  const bytes = Uint8Array.from(binary, (c) => c.charCodeAt(0));
  return JSON.parse(new TextDecoder().decode(bytes)) as Shared;
}

const filled = (values: object | undefined) => values && Object.keys(values).length > 0;

function currentState(): Shared {
  const { schema: _, ...terrain } = terrainDocument(committed.value);
  const changed = Object.fromEntries(
    Object.entries(weights.value).filter(([, values]) => filled(values)),
  );
  const result = runStale.value ? null : run.value;
  return {
    t: terrain,
    r: robotName.value,
    m: method.value,
    ...(filled(changed) ? { w: changed } : {}),
    ...(filled(controller.value) ? { c: controller.value } : {}),
    ...(seed.value ? { s: seed.value } : {}),
    ...(filled(disturbance.value) ? { d: disturbance.value } : {}),
    ...(compare.value ? { ab: 1 as const } : {}),
    ...(result ? { ro: result.id } : {}),
    ...(result && runB.value ? { rb: runB.value.id } : {}),
  };
}

export interface Restored {
  rollout: string | null;
  rolloutB: string | null;
}

/** Take the state out of the address. Null where there is none, or none that can be read. */
export function restoreFromAddress(): Restored | null {
  const text = new URLSearchParams(location.hash.slice(1)).get("s");
  if (!text) return null;
  let state: Shared;
  try {
    state = decode(text);
    if (!Array.isArray(state.t.points)) throw new TypeError("no points");
  } catch {
    toast.value = { text: "This link could not be read; the sample is shown instead." };
    return null;
  }
  const points = state.t.points.filter(
    (p): p is Vec2 => p.length === 2 && p.every(Number.isFinite),
  );
  const stored = terrains.peek().find((t) => t.name === state.t.name) ?? null;
  open({ ...state.t, points, schema: "stairwright/terrain/1" }, stored);
  robotName.value = state.r;
  method.value = state.m;
  weights.value = state.w ?? {};
  controller.value = state.c ?? {};
  seed.value = state.s ?? 0;
  disturbance.value = state.d ?? {};
  compare.value = state.ab === 1;
  return { rollout: state.ro ?? null, rolloutB: state.rb ?? null };
}

/** Browsers refuse an address that changes at every move of a slider [ms]. */
const REST = 250;

/** Keep the address up to date: after each finished edit, never during a drag. */
export function startSharing(): void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  effect(() => {
    const empty = isEmpty.value && origin.value === null;
    const parts = empty ? [] : [`s=${encode(currentState())}`];
    if (workspace.value !== "plan") parts.unshift(`v=${workspace.value}`);
    const hash = parts.length > 0 ? `#${parts.join("&")}` : "";
    clearTimeout(timer);
    timer = setTimeout(() => {
      if (hash !== location.hash) history.replaceState(null, "", hash || location.pathname);
    }, REST);
  });
}
