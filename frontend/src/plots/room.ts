/** Which plots are shown, and how many of them have room beside each other. */

import { computed, signal } from "@preact/signals";
import { oneArea } from "../state/view";
import type { PanelId } from "./lines";

/** In the order of the row; those that have no room are a step aside. */
export const shownPanels = signal<readonly PanelId[]>([
  "pitch",
  "thigh",
  "calf",
  "torque",
  "margins",
]);

/** The plot that has the row to itself. */
export const alonePlot = signal<PanelId | null>(null);

/** Narrower, and the numbers of a heading do not fit [px]. */
const LEAST = 220;

/** Width of the row of plots [px]; 0 before it was measured. */
export const rowWidth = signal(0);

/** Place of the row's first plot among those that are shown. */
const firstPlot = signal(0);

/** The plots in the row, and those to its left and right that have no room. */
export const row = computed(() => {
  const all = shownPanels.value;
  if (alonePlot.value) return { plots: [alonePlot.value], left: [], right: [] };
  // With one area at a time, the plots stand in rows that scroll.
  const room = oneArea.value ? all.length : Math.max(1, Math.floor(rowWidth.value / LEAST));
  const first = Math.max(0, Math.min(firstPlot.value, all.length - room));
  return {
    plots: all.slice(first, first + room),
    left: all.slice(0, first),
    right: all.slice(first + room),
  };
});

/** Another part of the row: one step, or as far as it goes. */
export function turnRow(steps: number): void {
  firstPlot.value = row.peek().left.length + steps;
}

/** Whether there was one plot alone. */
export function restorePlot(): boolean {
  const was = alonePlot.peek() !== null;
  alonePlot.value = null;
  return was;
}
