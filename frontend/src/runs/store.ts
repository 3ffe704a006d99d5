/** The stored results on screen: which are listed, which are pinned, and what changes them. */

import { batch, computed, effect, signal } from "@preact/signals";
import { reasonOf } from "../api/client";
import { type Entry, type EntryChanges, type Kind, listStored, patchStored } from "../api/stored";
import { report } from "../state/connection";
import { removal } from "../state/removal";
import { run, runB } from "../state/rollouts";
import { toast } from "../state/toast";
import { trials } from "../state/trials";

export type Filter = "all" | Kind;

const KINDS: readonly Kind[] = ["plans", "rollouts", "trials"];
/** Rows that are read at once. */
const PAGE = 40;

export const filter = signal<Filter>("rollouts");
export const search = signal("");
/** How many rows are asked for; "more" asks for more. */
const wanted = signal(PAGE);

const read = signal<Entry[]>([]);
export const total = signal(0);
export const loading = signal(true);
/** Why there is no list. */
export const trouble = signal<string | null>(null);
/** In the order in which they were pinned. */
const pins = signal<Entry[]>([]);

/** The user's name for it, else its terrain. */
export const title = (entry: Entry) => entry.name || entry.summary.terrain;

export const { doomed, remove } = removal<Entry>({
  path: ({ kind, id }) => `${kind}/${id}`,
  title,
  gone: (entry) =>
    batch(() => {
      read.value = read.peek().filter((each) => each.id !== entry.id);
      pins.value = pins.peek().filter((each) => each.id !== entry.id);
      total.value = Math.max(0, total.peek() - 1);
    }),
});

export const entries = computed(() => read.value.filter((each) => !doomed.value.has(each.id)));
export const pinned = computed(() => pins.value.filter((each) => !doomed.value.has(each.id)));
export const hasMore = computed(() => read.value.length < total.value);

const chosen = (): readonly Kind[] => (filter.value === "all" ? KINDS : [filter.value]);
const newest = (a: Entry, b: Entry) => b.created - a.created;

let asked = 0;

/** Read the list again; an older answer that comes later is dropped. */
export async function refresh(): Promise<void> {
  const mine = ++asked;
  const query = { limit: wanted.value, offset: 0, search: search.value };
  loading.value = true;
  try {
    const [lists, marked] = await Promise.all([
      Promise.all(chosen().map((kind) => listStored(kind, query))),
      Promise.all(KINDS.map((kind) => listStored(kind, { limit: 26, offset: 0, pinned: true }))),
    ]);
    if (mine !== asked) return;
    batch(() => {
      const found = lists.flatMap((list) => list.entries).sort(newest);
      read.value = found.slice(0, query.limit);
      total.value = lists.reduce((sum, list) => sum + list.total, 0);
      keepPins(marked.flatMap((list) => list.entries));
      trouble.value = null;
    });
  } catch (error) {
    if (mine !== asked) return;
    report(error);
    trouble.value = reasonOf(error);
  } finally {
    if (mine === asked) loading.value = false;
  }
}

/** Letters must not change hands: those known keep their order, others follow by age. */
function keepPins(now: Entry[]): void {
  const order = new Map(pins.peek().map((each, i) => [each.id, i]));
  const place = (each: Entry) => order.get(each.id) ?? Number.POSITIVE_INFINITY;
  pins.value = now.sort((a, b) => {
    const by = place(a) - place(b);
    return Number.isNaN(by) || by === 0 ? -newest(a, b) : by;
  });
}

export function more(): void {
  wanted.value += PAGE;
}

/**
 * While the workspace is open, read the list whenever what it shows is chosen anew, this page has
 * a result, or the user comes back from another window.
 */
export function startListing(): () => void {
  const stop = effect(() => {
    filter.value;
    search.value;
    wanted.value;
    run.value;
    runB.value;
    trials.value;
    void refresh();
  });
  addEventListener("focus", refresh);
  return () => {
    stop();
    removeEventListener("focus", refresh);
  };
}

export function narrow(change: { filter?: Filter; search?: string }): void {
  batch(() => {
    wanted.value = PAGE;
    if (change.filter) filter.value = change.filter;
    if (change.search !== undefined) search.value = change.search;
  });
}

function put(entry: Entry): void {
  const swap = (list: Entry[]) => list.map((each) => (each.id === entry.id ? entry : each));
  batch(() => {
    read.value = swap(read.peek());
    const there = pins.peek().some((each) => each.id === entry.id);
    if (!entry.pinned) pins.value = pins.peek().filter((each) => each.id !== entry.id);
    else pins.value = there ? swap(pins.peek()) : [...pins.peek(), entry];
  });
}

/** Name, note or pin; shown at once, taken back where the service says no. */
export async function change(entry: Entry, changes: EntryChanges): Promise<void> {
  put({ ...entry, ...changes });
  try {
    put(await patchStored(entry, changes));
  } catch (error) {
    put(entry);
    report(error);
    toast.value = { text: `Not saved: ${reasonOf(error)}` };
  }
}

export async function unpinAll(): Promise<void> {
  await Promise.all(pins.peek().map((each) => change(each, { pinned: false })));
}
