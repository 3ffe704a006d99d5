/** What toolbar and keyboard do to the drawing. */

import { restorePlot } from "../plots/room";
import { commit, drawing, redo, selection, undo } from "../state/drawing";
import { onLayoutKey, restore } from "../state/layout";
import { togglePlay } from "../state/playback";
import { legendOpen, type Tool, tool } from "../state/view";
import { save } from "../topbar/terrain-actions";
import { addVertex, moveVertices, removeVertices } from "./edits";
import { cancelGesture, holdSpace, releaseSpace } from "./gestures";
import { liftPen } from "./pen";

export const TOOL_KEYS: Record<string, Tool> = {
  v: "select",
  s: "stair",
  r: "ramp",
  f: "flat",
  p: "free",
};

const NEAR = 0.01;
const FAR = 0.1;
const FINE = 0.001;

export function deleteSelected(): void {
  const which = selection.peek();
  if (which.length === 0) return;
  const next = Math.max(0, which[0]! - 1);
  commit({ points: removeVertices(drawing.peek().points, which) });
  selection.value = drawing.peek().points.length > 2 ? [next] : [];
  focusVertex(next);
}

/** A new corner after the selected one, or in the middle of the profile. */
export function insertVertex(): void {
  const points = drawing.peek().points;
  if (points.length < 2) return;
  const wanted = selection.peek()[0] ?? Math.floor((points.length - 1) / 2);
  const added = addVertex(points, Math.min(wanted, points.length - 2));
  commit({ points: added.points });
  selection.value = [added.index];
  focusVertex(added.index);
}

export function nudge(dx: number, dz: number): void {
  const which = selection.peek();
  if (which.length > 0) commit({ points: moveVertices(drawing.peek().points, which, dx, dz) });
}

export function selectAll(): void {
  selection.value = drawing.peek().points.map((_, i) => i);
}

/**
 * At once, not after the next drawing: corners keep their elements by index and the selected one's
 * neighbours are always drawn, so the element is there, and the next key must find the focus on it.
 */
function focusVertex(i: number): void {
  const element = () => document.querySelector<SVGElement>(`[data-vertex="${i}"]`);
  if (element()) element()?.focus();
  // Of many corners one that was not beside a selected one is drawn only now.
  else requestAnimationFrame(() => element()?.focus());
}

export const isField = (target: EventTarget | null) =>
  target instanceof HTMLElement && /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName);

const ARROWS: Record<string, [number, number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

/** Keys of the workspace Plan; a text field keeps its own. */
export function onPageKey(event: KeyboardEvent): void {
  if (isField(event.target) || event.defaultPrevented) return;
  const key = event.key.toLowerCase();
  if (event.ctrlKey || event.metaKey) {
    if (key === "z") {
      event.preventDefault();
      if (event.shiftKey) redo();
      else undo();
    } else if (key === "s") {
      event.preventDefault();
      void save();
    } else if (key === "y") {
      event.preventDefault();
      redo();
    } else if (key === "a" && isVertex(event.target)) {
      event.preventDefault();
      selectAll();
    }
    return;
  }
  if (event.altKey) return;
  const next = TOOL_KEYS[key];
  if (next) tool.value = next;
  else if (onLayoutKey(key)) event.preventDefault();
  else if (key === "l") legendOpen.value = !legendOpen.peek();
  else if (
    event.key === "Escape" &&
    !cancelGesture() &&
    !liftPen() &&
    !restorePlot() &&
    !restore()
  ) {
    tool.value = "select";
    selection.value = [];
  } else if (event.key === " " && !isButton(event.target)) {
    event.preventDefault();
    if (!event.repeat) holdSpace();
  } else if (event.target === document.body && selection.peek().length > 0) {
    // A selection by rectangle leaves the focus on the page; its keys work all the same.
    onVertexKey(event);
  }
}

export function onPageKeyUp(event: KeyboardEvent): void {
  if (event.key === " " && releaseSpace()) togglePlay();
}

const isVertex = (target: EventTarget | null) =>
  target instanceof SVGElement && target.dataset.vertex !== undefined;

const isButton = (target: EventTarget | null) =>
  target instanceof HTMLElement &&
  target.closest("button, [role=slider], [role=menu], a, iframe") !== null;

/** Which corner a key goes to from the selected one; the arrows move the corner itself. */
function cornerByKey(key: string): number | undefined {
  const last = drawing.peek().points.length - 1;
  const at = selection.peek()[0] ?? 0;
  const to = { PageDown: at + 1, PageUp: at - 1, Home: 0, End: last }[key];
  return to === undefined ? undefined : Math.min(last, Math.max(0, to));
}

/** Keys while a corner has the focus. */
export function onVertexKey(event: KeyboardEvent): void {
  const arrow = ARROWS[event.key];
  const corner = cornerByKey(event.key);
  if (corner !== undefined) {
    event.preventDefault();
    event.stopPropagation();
    focusVertex(corner);
  } else if (arrow) {
    event.preventDefault();
    event.stopPropagation();
    const step = event.shiftKey ? FAR : event.altKey ? FINE : NEAR;
    nudge(arrow[0] * step, arrow[1] * step);
  } else if (event.key === "Delete" || event.key === "Backspace") {
    event.preventDefault();
    deleteSelected();
  } else if (event.key === "Enter") {
    event.preventDefault();
    document.querySelector<HTMLInputElement>(".ro input")?.focus();
  } else if (event.key === "+" || event.key === "Insert") {
    insertVertex();
  }
}
