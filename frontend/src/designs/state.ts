/** Design searches of this service: which there are, the one that is shown, the design in view. */

import { batch, computed, effect, signal } from "@preact/signals";
import { ApiError, BASE, call, callJson, reasonOf } from "../api/client";
import { inOrder } from "../api/in-order";
import type { components } from "../api/schema";
import { report } from "../state/connection";
import { readFlag, kept as remembered } from "../state/kept";
import { removal } from "../state/removal";
import { documentOf, refusal, refused } from "./form";
import { wordsOf } from "./words";

type Schemas = components["schemas"];
export type Summary = Schemas["DesignDocument"];
export type Search = Schemas["DesignAnswer"];
export type Candidate = Schemas["Candidate"];
export type Aim = Schemas["Aim"];

/** The Map shows fronts of design searches instead of cells. */
export const showsDesigns = remembered("designs", false, readFlag);
const listed = signal<Summary[]>([]);
export const search = signal<Search | null>(null);
export const trouble = signal<string | null>(null);
/** The design under pointer or focus, by its number; the best of the first aim before that. */
const pointed = signal<number | null>(null);
/** What the axes of the drawing show, as indices of the aims. */
export const across = signal<readonly [number, number]>([0, 1]);

export const aimName = (aim: Aim): string => aim.minimise ?? aim.maximise ?? "";

/** What a list or a sentence calls a search. */
export const title = (each: Summary) =>
  each.name || each.aims.map((aim) => wordsOf(aimName(aim)).title).join(", ");

const removed = removal<Summary>({
  path: ({ id }) => path(id),
  title: (each) => `The search “${title(each)}”`,
  gone: () => readList().catch(report),
});
export const summaries = computed(() =>
  listed.value.filter((each) => !removed.doomed.value.has(each.id)),
);

/** A search with all that it has tried. */
export function remove(each: Summary): void {
  const shown = search.peek()?.id === each.id;
  if (shown) {
    wanted = "";
    search.value = null;
  }
  removed.remove(each, () => shown && void openSearch(each.id));
}

/** Numbers of the best designs, by their first aim. */
export const front = computed<number[]>(() => {
  const shown = search.value;
  if (!shown) return [];
  const first = aimName(shown.design.aims[0]!);
  const best = shown.candidates.flatMap((each, i) => (each.best ? [i] : []));
  const reached = (i: number) => shown.candidates[i]!.aims[first] ?? 0;
  return best.sort((a, b) => reached(a) - reached(b));
});

export const inView = computed<number | null>(() => {
  const at = pointed.value;
  return at !== null && search.value?.candidates[at] ? at : (front.value[0] ?? null);
});

export function pointAt(candidate: number): void {
  pointed.value = candidate;
}

function show(found: Search): void {
  batch(() => {
    if (search.peek()?.id !== found.id) {
      pointed.value = null;
      across.value = [0, 1];
    }
    search.value = found;
    trouble.value = null;
  });
}

function say(error: unknown): void {
  report(error);
  trouble.value = reasonOf(error);
}

/** The search that was asked for last: answers about others come too late. */
let wanted: string | null = null;

export async function openSearch(id: string): Promise<void> {
  wanted = id;
  await read(id);
}

const path = (id: string) => `designs/${encodeURIComponent(id)}`;

async function read(id: string): Promise<void> {
  try {
    const found = await callJson<Search>("GET", path(id));
    if (wanted === id) show(found);
  } catch (error) {
    if (error instanceof ApiError && error.status === 404) {
      trouble.value = "This service does not have that search. Run starts one as the form says.";
    } else say(error);
  }
}

/** A result that `stairwright design -o` has written, wherever that was. */
export async function openFile(file: File): Promise<void> {
  try {
    const found = JSON.parse(await file.text()) as Partial<Search>;
    if (found.schema !== "stairwright/design-result/1") throw new TypeError();
    wanted = found.id ?? null;
    show(found as Search);
  } catch {
    trouble.value = `${file.name} is no result of a design search (stairwright/design-result/1).`;
  }
}

/** How far the shown search is, where this service knows it. */
export const shownState = computed<Summary | null>(
  () => summaries.value.find((each) => each.id === search.value?.id) ?? null,
);
const atWork = (each: Summary | null) => ["queued", "running"].includes(each?.state ?? "");
export const searching = computed(() => atWork(shownState.value));

async function submit(document: unknown): Promise<void> {
  refusal.value = null;
  try {
    const begun = await callJson<Summary>("POST", "designs", document);
    await Promise.all([readList(), openSearch(begun.id)]);
  } catch (error) {
    report(error);
    refusal.value = error instanceof ApiError ? refused(error) : reasonOf(error);
  }
}

/** Search as the form says, or go on with that search: the same question is the same search. */
export async function start(): Promise<void> {
  const document = documentOf();
  if (document) await submit(document);
}

/** Go on with the shown search as it was asked, whatever the form says now. */
export async function goOn(): Promise<void> {
  const shown = search.peek();
  if (shown) await submit(shown.design);
}

export async function pause(): Promise<void> {
  const id = search.peek()?.id;
  try {
    if (id) await call("POST", `${path(id)}/cancel`);
    await readList();
  } catch (error) {
    say(error);
  }
}

const readList = inOrder(
  () => callJson<Summary[]>("GET", "designs"),
  (list) => {
    listed.value = list;
  },
);

/** Between looks at the list [ms]. */
const EVERY = 3000;

/** Read the list while the room is open, and follow the shown search while it is at work. */
export function followSearches(): () => void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  let left = false;
  const look = async () => {
    try {
      await readList();
      if (wanted === null && summaries.peek()[0]) await openSearch(summaries.peek()[0]!.id);
      catchUp();
    } catch (error) {
      report(error);
    }
    if (!left) timer = setTimeout(look, EVERY);
  };
  void look();
  const live = computed(() => (searching.value ? search.value!.id : null));
  const stop = effect(() => {
    if (!live.value) return;
    const source = new EventSource(`${BASE}/${path(live.value)}/events`);
    source.addEventListener("design", (event) => {
      const news = JSON.parse(event.data) as Summary;
      if (!atWork(news)) source.close();
      listed.value = listed.peek().map((each) => (each.id === news.id ? news : each));
      catchUp();
    });
    return () => source.close();
  });
  return () => {
    left = true;
    clearTimeout(timer);
    stop();
  };
}

let catching = false;

/** Read the shown search again until it has all that its summary tells of. */
async function catchUp(): Promise<void> {
  if (catching) return;
  catching = true;
  for (let before = -1; ; ) {
    const tried = search.peek()?.candidates.length ?? 0;
    const news = shownState.peek();
    if (!news || news.tried === tried || tried === before) break;
    before = tried;
    await read(news.id);
  }
  catching = false;
}
