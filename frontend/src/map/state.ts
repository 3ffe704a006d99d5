/** The study that the Map shows: asked, followed as its cells come, cancelled, opened again. */

import { batch, computed, effect, signal, untracked } from "@preact/signals";
import { ApiError, reasonOf } from "../api/client";
import { inOrder } from "../api/in-order";
import { report } from "../state/connection";
import { removal } from "../state/removal";
import { decode, encode, given, kept } from "../state/share";
import { Cube, type Field, fieldOf, type Layout, layoutOf } from "./cube";
import { documentOf, type Form, form, formOf } from "./form";
import { axisKind, LEAST } from "./quantities";
import {
  cancelStudy,
  followStudy,
  getStudy,
  getStudyDocument,
  listStudies,
  postStudy,
  type StudyAxis,
  type StudyState,
} from "./studies";

export const study = signal<StudyState | null>(null);
/** Names of what was asked, from the study's own document. */
export const asked = signal<{ robot: string; friction: number | null } | null>(null);
/** The packages that studies need are not there: what the service says about it. */
export const missing = signal<string | null>(null);
export const refusal = signal<string | null>(null);
const listed = signal<StudyState[]>([]);

/** What a list or a sentence calls a study. */
export const title = (each: StudyState) =>
  each.name || each.axes.map((axis) => axisKind(axis.name).title.toLowerCase()).join(" × ");

const removed = removal<StudyState>({
  path: ({ id }) => `studies/${encodeURIComponent(id)}`,
  title: (each) => `The map “${title(each)}”`,
  gone: () => readList(),
});
export const earlier = computed(() =>
  listed.value.filter((each) => !removed.doomed.value.has(each.id)),
);

/** What cells are coloured by. Friction is worth it once the least that does is searched for. */
export const quantity = signal("margin_com");
/** Chosen values of axes that are neither x nor y, as indices. */
export const slices = signal<Readonly<Record<string, number>>>({});
/** Two robots: which picture is drawn. */
export const pairView = signal<"both" | "difference">("both");

let cube: Cube | null = null;
let leave: () => void = () => undefined;
/** Counts the blocks that were drawn; a block that comes in the same frame waits for the next. */
const drawn = signal(0);
let due = false;

function redraw(): void {
  if (due) return;
  due = true;
  requestAnimationFrame(() => {
    due = false;
    drawn.value += 1;
  });
}

export const layout = computed<Layout | null>(() =>
  study.value ? layoutOf(study.value.axes) : null,
);

/** The axis of two robots, if there is one: its places are drawn side by side. */
export const robotAxis = computed<StudyAxis | null>(() => {
  const axes = study.value?.axes ?? [];
  return axes.find((axis) => axis.name === "robot" && axis.values.length === 2) ?? null;
});

export const ready = (): Cube | null => (drawn.value < 0 ? null : cube);

/** The field of each robot; one where there is one. */
export const fields = computed<Field[]>(() => {
  const [where, now] = [layout.value, ready()];
  if (!where || !now) return [];
  const at = where.others.map((k) => slices.value[now.axes[k]!.name] ?? 0);
  const pair = robotAxis.value;
  if (!pair) return [fieldOf(now, where, at)];
  const place = where.others.findIndex((k) => now.axes[k] === pair);
  return [0, 1].map((robot) => fieldOf(now, where, at.with(place, robot)));
});

export const atWork = computed(() => ["queued", "running"].includes(study.value?.state ?? ""));

function say(error: unknown): void {
  report(error);
  if (error instanceof ApiError && error.status === 501) {
    missing.value = error.problem.detail ?? error.message;
  } else refusal.value = reasonOf(error);
}

/** Ask what the form says, or go on with it: the same question is the same study. */
export async function start(): Promise<void> {
  const document = documentOf(form.peek());
  if (!document) return;
  await submit(document);
}

async function submit(document: Record<string, unknown>): Promise<void> {
  refusal.value = null;
  try {
    show(await postStudy(document));
  } catch (error) {
    say(error);
  }
}

function show(state: StudyState): void {
  leave();
  const again = study.peek()?.id === state.id;
  batch(() => {
    study.value = state;
    if (!again || !cube) cube = new Cube(state.axes);
    if (!again) {
      asked.value = null;
      slices.value = {};
      // At the border the margins are thin by definition.
      if (state.axes.some((axis) => axis.boundary)) quantity.value = LEAST;
    }
    drawn.value += 1;
  });
  leave = followStudy(state.id, {
    cells: (block) => {
      cube?.take(block);
      redraw();
    },
    state: (next) => {
      const { axes } = study.peek() ?? state;
      study.value = { ...next, axes };
      if (!["queued", "running"].includes(next.state)) void readList();
    },
  });
  void readAsked(state.id);
}

async function readAsked(id: string): Promise<void> {
  try {
    const document = await getStudyDocument(id);
    const robot = document.robot as { name?: string } | string | undefined;
    const friction = document.friction as number | null | undefined;
    if (study.peek()?.id !== id) return;
    asked.value = {
      robot: typeof robot === "string" ? robot : (robot?.name ?? ""),
      friction: friction ?? null,
    };
  } catch (error) {
    report(error);
  }
}

export async function openStudy(id: string): Promise<void> {
  refusal.value = null;
  try {
    const state = await getStudy(id);
    show(state);
    form.value = formOf(state.axes, await getStudyDocument(id));
  } catch (error) {
    if (error instanceof ApiError && error.status === 404) {
      refusal.value = "This service has not computed that map. Run computes it.";
    } else say(error);
  }
}

export async function cancel(): Promise<void> {
  const id = study.peek()?.id;
  if (id) await cancelStudy(id).catch(say);
}

/** Go on with a study that was cancelled or failed: as it was asked, whatever the form says now. */
export async function resume(): Promise<void> {
  const id = study.peek()?.id;
  if (!id) return;
  try {
    await submit(await getStudyDocument(id));
  } catch (error) {
    say(error);
  }
}

/** The shown study with all its cells. */
export function remove(): void {
  const shown = study.peek();
  if (!shown) return;
  leave();
  cube = null;
  study.value = null;
  removed.remove(shown, () => void openStudy(shown.id));
}

const newestList = inOrder(listStudies, (list) => {
  listed.value = list;
});

export const readList = (): Promise<void> => newestList().catch(report);

interface Kept {
  i?: string;
  f: Form;
  q: string;
  s?: Record<string, number>;
}

let begun = false;

/** The first time that the room is open: what the address names, and from now on keep it there. */
export function begin(): void {
  if (begun) return;
  begun = true;
  effect(() => {
    const text = given.value.get("m");
    if (text && text !== kept.peek().m) untracked(() => restore(text));
  });
  void readList();
  effect(() => {
    const state: Kept = { f: form.value, q: quantity.value };
    if (study.value) state.i = study.value.id;
    if (Object.keys(slices.value).length > 0) state.s = { ...slices.value };
    kept.value = { ...kept.peek(), m: encode(state) };
  });
}

function restore(text: string): void {
  try {
    const state = decode(text) as Kept;
    if (typeof state.f.x.name !== "string" || typeof state.f.y.name !== "string") throw 0;
    form.value = { ...form.peek(), ...state.f };
    quantity.value = String(state.q);
    if (state.i) {
      void openStudy(state.i).then(() => {
        quantity.value = String(state.q);
        slices.value = state.s ?? {};
      });
    }
  } catch {
    refusal.value = "The map in this link could not be read.";
  }
}
