/** How the workspace Plan divides its room: profile, scene, inspector and dock. */

import { signal } from "@preact/signals";
import { kept, readFlag, readWithin } from "./kept";

/** What the stage shows; each can have it alone. */
export type StagePanel = "editor" | "scene";

export interface Limits {
  least: number;
  most: number;
  /** What a double click goes back to. */
  first: number;
}

/** Share of the stage's width that the left panel has. */
export const SPLIT: Limits = { least: 0.25, most: 0.75, first: 0.5 };
/** Share of the page's height that results and plots have; style sheets see to 120 px at least. */
export const DOCK: Limits = { least: 0.12, most: 0.6, first: 0.25 };

export const split = kept("split", SPLIT.first, readWithin(SPLIT.least, SPLIT.most));
export const dock = kept("dock", DOCK.first, readWithin(DOCK.least, DOCK.most));
export const swapped = kept("swapped", false, readFlag);
/** Beside two panels there is no room for it on a small screen, until it is asked for. */
const isSmall = matchMedia("(min-width: 900px) and (max-width: 1200px)").matches;
export const inspectorOpen = kept("inspector", !isSmall, readFlag);

export const maximised = signal<StagePanel | null>(null);
/** The panel that pointer or focus was in last: the one that the key M means. */
export const lastPanel = signal<StagePanel>("editor");

export function maximise(panel: StagePanel): void {
  maximised.value = maximised.peek() === panel ? null : panel;
}

/** Whether there was anything to restore. */
export function restore(): boolean {
  const was = maximised.peek() !== null;
  maximised.value = null;
  return was;
}

/** Keys of the layout: X swaps, M maximises, I closes the inspector. */
export function onLayoutKey(key: string): boolean {
  if (key === "x") swapped.value = !swapped.peek();
  else if (key === "m") maximise(maximised.peek() ?? lastPanel.peek());
  else if (key === "i") inspectorOpen.value = !inspectorOpen.peek();
  else return false;
  return true;
}
