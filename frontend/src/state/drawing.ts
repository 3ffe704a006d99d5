/** The document of the page: the drawn profile with its name and friction; and the history. */

import { batch, computed, effect, signal } from "@preact/signals";
import type { TerrainDocument, Vec2 } from "../api/types";
import { type Points, samePoints } from "../geometry/profile";
import { type Choices, choices, choose, terrains } from "./setup";

export interface Drawing {
  name: string;
  description: string;
  points: Points;
  friction: number;
  start: number | null;
  goal: number | null;
}

export const UNTITLED: Drawing = {
  name: "Untitled",
  description: "",
  points: [],
  friction: 0.6,
  start: null,
  goal: null,
};

const LONGEST_HISTORY = 200;

/** What is on the canvas now; changes at every frame of a drag. */
export const drawing = signal<Drawing>(UNTITLED);
/** What the last finished edit left; link and history follow this one. */
export const committed = signal<Drawing>(UNTITLED);
const originName = signal<string | null>(null);
/** The stored terrain that the drawing started from. */
export const origin = computed(
  () => terrains.value.find((terrain) => terrain.name === originName.value) ?? null,
);
/** Selected vertices, ascending. */
export const selection = signal<readonly number[]>([]);

/** Where undo leads: a drawing and what was set beside it. */
interface Step {
  drawing: Drawing;
  originName: string | null;
  choices: Choices;
}

const past = signal<readonly Step[]>([]);
const future = signal<readonly Step[]>([]);
/** What was set when the last step was made. */
let chosen = choices.peek();

export const canUndo = computed(() => past.value.length > 0);
export const canRedo = computed(() => future.value.length > 0);
/** Parts of the drawing that a drag of its corners leaves as they are. */
export const drawnName = computed(() => drawing.value.name);
export const drawnFriction = computed(() => drawing.value.friction);
export const isEmpty = computed(() => drawing.value.points.length < 2);

export const isEdited = computed(() => {
  const now = drawing.value;
  const base = origin.value;
  if (!base) return now.points.length > 0;
  return !samePoints(base.points, now.points) || base.friction !== now.friction;
});

/** The profile as it was one edit ago, for sentences such as "this edit raised the riser". */
export const previous = computed(() => past.value[past.value.length - 1]?.drawing ?? null);

/** Change what is on the canvas without a step in the history (during a drag). */
export function draft(change: Partial<Drawing>): void {
  drawing.value = { ...drawing.value, ...change };
}

/** Finish an edit: one step in the history, however many drafts led to it. */
export function commit(change: Partial<Drawing> = {}): void {
  const next = { ...drawing.value, ...change };
  const before = committed.peek();
  drawing.value = next;
  if (before.friction === next.friction && samePoints(before.points, next.points)) return;
  commitChoices();
  remember();
  committed.value = next;
}

const now = (): Step => ({
  drawing: committed.peek(),
  originName: originName.peek(),
  choices: chosen,
});

function remember(): void {
  past.value = [...past.value.slice(-LONGEST_HISTORY), now()];
  future.value = [];
}

/** Finish a change of settings: one step, however far a slider went. */
export function commitChoices(): void {
  if (JSON.stringify(choices.peek()) === JSON.stringify(chosen)) return;
  remember();
  chosen = choices.peek();
}

/** A slider at rest is a finished change [ms]. */
const REST = 500;

/** A hand has hold of something: what it passes on the way is no step. */
export const held = signal(false);

/** Settings take part in the history from now on. */
export function startHistory(): void {
  chosen = choices.peek();
  let timer: ReturnType<typeof setTimeout> | undefined;
  effect(() => {
    choices.value;
    clearTimeout(timer);
    timer = setTimeout(() => held.peek() || commitChoices(), REST);
  });
}

/** Give up a drag. */
export function revert(): void {
  drawing.value = committed.peek();
}

export function undo(): void {
  commitChoices();
  const before = past.value[past.value.length - 1];
  if (!before) return;
  past.value = past.value.slice(0, -1);
  future.value = [now(), ...future.value];
  restore(before);
}

export function redo(): void {
  const next = future.value[0];
  if (!next) return;
  future.value = future.value.slice(1);
  past.value = [...past.value, now()];
  restore(next);
}

function restore(step: Step): void {
  const state = step.drawing;
  batch(() => {
    drawing.value = state;
    committed.value = state;
    originName.value = step.originName;
    selection.value = selection.peek().filter((i) => i < state.points.length);
    chosen = step.choices;
    choose(chosen);
  });
}

/**
 * Open another terrain: undo leads back to the one before.
 * @param from the name of the stored one that it is, if it is one
 * @param settle changes the settings that belong to it, in the same step
 */
export function open(terrain: TerrainDocument, from: string | null, settle?: () => void): void {
  const next: Drawing = {
    name: terrain.name,
    description: terrain.description ?? "",
    points: terrain.points.map((p): Vec2 => [p[0], p[1]]),
    friction: terrain.friction,
    start: terrain.start ?? null,
    goal: terrain.goal ?? null,
  };
  batch(() => {
    if (committed.peek().points.length > 0) {
      commitChoices();
      remember();
    }
    future.value = [];
    originName.value = from;
    selection.value = [];
    drawing.value = next;
    committed.value = next;
    settle?.();
    chosen = choices.peek();
  });
}

/** What is drawn is stored under this name now. */
export function storedAs(name: string, description: string): void {
  originName.value = name;
  drawing.value = { ...drawing.peek(), name, description };
  committed.value = { ...committed.peek(), name, description };
}

export function clear(): void {
  open({ ...UNTITLED, schema: "stairwright/terrain/1", points: [] }, null);
}

/** The drawing as the document that REST takes. Start and goal fall away once the ground moved. */
export function terrainDocument(state: Drawing): TerrainDocument {
  const [first, last] = [state.points[0], state.points[state.points.length - 1]];
  const inside = (x: number | null) =>
    x !== null && first && last && x >= first[0] && x <= last[0] ? x : null;
  return {
    schema: "stairwright/terrain/1",
    name: state.name,
    description: state.description,
    points: state.points.map((p): Vec2 => [p[0], p[1]]),
    friction: state.friction,
    start: inside(state.start),
    goal: inside(state.goal),
  };
}
