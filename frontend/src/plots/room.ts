/** Which plots are shown, and how many of them have room beside each other. */

import { signal } from "@preact/signals";
import { oneArea } from "../state/view";
import type { PanelId } from "./lines";

/** In the order of the row; the last ones fall away where there is no room for them. */
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
/** With one area at a time, the plots stand in rows that scroll. */
const IN_ROWS = 4;

/** Width of the row of plots [px]; 0 before it was measured. */
export const rowWidth = signal(0);

export const roomFor = (width: number) =>
  width > 0 && !oneArea.value ? Math.max(1, Math.floor(width / LEAST)) : IN_ROWS;

/** Whether there was one plot alone. */
export function restorePlot(): boolean {
  const was = alonePlot.peek() !== null;
  alonePlot.value = null;
  return was;
}
