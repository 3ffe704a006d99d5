/** How many plots have room beside each other. */

import { signal } from "@preact/signals";

/** Narrower, and the numbers of a heading do not fit [px]. */
const LEAST = 220;
/** Below this the plots stand in rows that scroll [px]. */
const ROWS = 900;
const IN_ROWS = 4;

/** Width of the row of plots [px]; 0 before it was measured. */
export const rowWidth = signal(0);

export const roomFor = (width: number) =>
  width > 0 && innerWidth >= ROWS ? Math.max(1, Math.floor(width / LEAST)) : IN_ROWS;
