/** The address: `#s=` and the state, enough to see the same page elsewhere; `v=` the workspace,
 * and what workspaces keep there under letters of their own. */

import { effect, signal } from "@preact/signals";
import type {
  FacingChoice,
  Method,
  SentRobot,
  SettingValues,
  TerrainDocument,
  Vec2,
} from "../api/types";
import { robotShape } from "../geometry/robot";
import { committed, isEmpty, open, origin, terrainDocument } from "./drawing";
import { run, runB, runStale } from "./rollouts";
import {
  allRobots,
  chosenFacing,
  compare,
  controller,
  disturbance,
  method,
  robotName,
  robotSource,
  seed,
  sentRobot,
  storedRobot,
  timing,
  tolerance,
  weights,
} from "./setup";
import { takeRobot } from "./taken-robot";
import { toast } from "./toast";
import { workspace } from "./workspace";

/** Short keys: the whole of this stands in the link. */
interface Shared {
  t: Omit<TerrainDocument, "schema">;
  r: string;
  /** The robot itself, where it is no preset. */
  rd?: SentRobot;
  m: Method;
  /** Fast timing. */
  f?: 1;
  /** Which end shall lead, where that was said; 1 is backward. */
  b?: 1 | FacingChoice;
  w?: Partial<Record<Method, SettingValues>>;
  /** Tolerance. */
  l?: SettingValues;
  c?: SettingValues;
  s?: number;
  /** Disturbance. */
  d?: SettingValues;
  ab?: 1;
  /** Rollouts A and B, as ids. */
  ro?: string;
  rb?: string;
}

const inAddress = () => new URLSearchParams(location.hash.slice(1));

/** What stood in the address that was opened or pasted last; the page's own is written over it. */
export const given = signal(inAddress());
/** What other workspaces keep in the address, by their letter. */
export const kept = signal<Readonly<Record<string, string>>>({});

/** A value as the address takes it. */
export function encode(state: unknown): string {
  const bytes = new TextEncoder().encode(JSON.stringify(state));
  let text = "";
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
}

/** Throws where the text is none of `encode`'s. */
export function decode(text: string): unknown {
  const binary = atob(text.replace(/-/g, "+").replace(/_/g, "/"));
  const bytes = Uint8Array.from(binary, (c) => c.charCodeAt(0));
  return JSON.parse(new TextDecoder().decode(bytes));
}

const filled = (values: object | undefined) => values && Object.keys(values).length > 0;

/** What no name stands for elsewhere and later: a robot that is no preset. */
function carriedRobot(): SentRobot | null {
  const source = robotSource.value;
  if (typeof source !== "string") return source;
  const stored = storedRobot.value;
  return stored && !stored.readonly ? sentRobot(stored) : null;
}

function currentState(): Shared {
  const { schema: _, ...terrain } = terrainDocument(committed.value);
  const changed = Object.fromEntries(
    Object.entries(weights.value).filter(([, values]) => filled(values)),
  );
  const carried = carriedRobot();
  const result = runStale.value ? null : run.value;
  const end = chosenFacing.value;
  return {
    t: terrain,
    r: robotName.value,
    ...(carried ? { rd: carried } : {}),
    m: method.value,
    ...(timing.value === "fast" ? { f: 1 as const } : {}),
    ...(end ? { b: end === "backward" ? (1 as const) : end } : {}),
    ...(filled(changed) ? { w: changed } : {}),
    ...(filled(tolerance.value) ? { l: tolerance.value } : {}),
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

const stateInAddress = () => inAddress().get("s");

/**
 * Take the state out of the address. Null where there is none, or none that can be read.
 * @param instead what is shown where it cannot be read
 */
export function restoreFromAddress(instead = "the sample is shown instead"): Restored | null {
  const text = stateInAddress();
  if (!text) return null;
  let state: Shared;
  try {
    state = decode(text) as Shared;
    if (!Array.isArray(state.t.points) || !Number.isFinite(state.t.friction))
      throw new TypeError("no terrain");
    if (state.rd) robotShape(state.rd); // which throws where it is no robot
  } catch {
    toast.value = { text: `This link could not be read; ${instead}.` };
    return null;
  }
  const points = state.t.points.filter(
    (p): p is Vec2 => p.length === 2 && p.every(Number.isFinite),
  );
  open({ ...state.t, points, schema: "stairwright/terrain/1" }, state.t.name, () => {
    if (state.rd) takeRobot(state.rd);
    else takeNamed(state.r);
    method.value = state.m;
    timing.value = state.f ? "fast" : "steady";
    chosenFacing.value = state.b === 1 ? "backward" : (state.b ?? null);
    weights.value = state.w ?? {};
    tolerance.value = state.l ?? {};
    controller.value = state.c ?? {};
    seed.value = state.s ?? 0;
    disturbance.value = state.d ?? {};
    compare.value = state.ab === 1;
  });
  return { rollout: state.ro ?? null, rolloutB: state.rb ?? null };
}

function takeNamed(name: string): void {
  if (allRobots.peek().some((each) => each.name === name)) robotName.value = name;
  else
    toast.value = {
      text: `The robot ${name} of this link is not here; ${robotName.peek()} is shown instead.`,
    };
}

/** Browsers refuse an address that changes at every move of a slider [ms]. */
const REST = 250;

/**
 * Keep the address up to date: after each finished edit, never during a drag. An address that is
 * pasted into the open page is followed.
 * @param take is given the results that such an address names
 */
export function startSharing(take: (restored: Restored | null) => void): void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  let followed = location.hash;
  const typed = signal(0);
  addEventListener("hashchange", () => {
    followed = location.hash;
    const text = stateInAddress();
    if (text && text !== encode(currentState())) take(restoreFromAddress("what was open stays"));
    given.value = inAddress();
    typed.value++;
  });
  effect(() => {
    // An address that was typed in part is completed.
    typed.value;
    const empty = isEmpty.value && origin.value === null;
    const parts = empty ? [] : [`s=${encode(currentState())}`];
    for (const [letter, text] of Object.entries(kept.value)) parts.unshift(`${letter}=${text}`);
    if (workspace.value !== "plan") parts.unshift(`v=${workspace.value}`);
    const hash = parts.length > 0 ? `#${parts.join("&")}` : "";
    clearTimeout(timer);
    timer = setTimeout(() => {
      // One that was pasted just now is about to be followed, not to be overwritten.
      if (hash === location.hash || location.hash !== followed) return;
      history.replaceState(null, "", hash || location.pathname);
      followed = location.hash;
    }, REST);
  });
}
