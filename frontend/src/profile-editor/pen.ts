/** Corners drawn click by click with the tool Free, one undo step each. */

import { effect, signal } from "@preact/signals";
import type { Vec2 } from "../api/types";
import type { Points } from "../geometry/profile";
import { commit, committed } from "../state/drawing";
import { tool } from "../state/view";
import { addFree } from "./edits";
import { riserTolerance } from "./snap";

/** Corners that were clicked so far; the line goes on from the last one. */
export const pen = signal<readonly Vec2[]>([]);
/** The ground that the line is drawn over, and what the last click made of it. */
let base: Points = [];
let made: Points | null = null;

export function liftPen(): boolean {
  const was = pen.peek().length > 0;
  pen.value = [];
  made = null;
  return was;
}

/** The next corner: one click begins a line, each further one draws a stretch. */
export function penCorner(at: Vec2): void {
  const now = committed.peek().points;
  // Undo, or another edit: what was clicked before is not what is on the canvas.
  if (pen.peek().length === 0 || now !== (made ?? base)) {
    liftPen();
    base = now;
  }
  const last = pen.peek()[pen.peek().length - 1];
  const upright = last && Math.abs(at[0] - last[0]) <= riserTolerance.peek();
  const corner: Vec2 = upright ? [last[0], at[1]] : at;
  pen.value = [...pen.peek(), corner];
  if (pen.peek().length < 2) return;
  commit({ points: addFree(base, pen.peek(), 0) });
  made = committed.peek().points;
}

/** Another tool ends the line. */
effect(() => {
  if (tool.value !== "free") liftPen();
});
