/** Pointers on the canvas: drag corners and stretches, draw with a tool, pan, pinch, select. */

import { signal } from "@preact/signals";
import type { Vec2 } from "../api/types";
import { heightAt, type Points } from "../geometry/profile";
import { commit, draft, drawing, revert, selection } from "../state/drawing";
import { stir } from "../state/planner";
import { dismissHint, tool } from "../state/view";
import { addFlat, addFree, addRamp, addStairs, addVertex, moveVertices } from "./edits";
import { penCorner } from "./pen";
import { code, onGrid, type Snapped, snap, uprightWithin } from "./snap";
import { pan, toWorld, view, zoomAt } from "./viewport";

/** Guide lines of a snapped drag. */
export const guides = signal<Snapped | null>(null);
/** Selection rectangle in pixels: x, y, x, y. */
export const marquee = signal<[number, number, number, number] | null>(null);
export const dragging = signal<"vertex" | "segment" | "pan" | "tool" | "marquee" | null>(null);
/** Space is held: the next drag pans. */
export const spaceHeld = signal(false);
let spacePanned = false;

export function holdSpace(): void {
  spaceHeld.value = true;
  spacePanned = false;
}

/** True where Space was only tapped, not held for a drag. */
export function releaseSpace(): boolean {
  const tapped = spaceHeld.peek() && !spacePanned;
  spaceHeld.value = false;
  return tapped;
}

interface Drag {
  kind: NonNullable<typeof dragging.value>;
  id: number;
  from: Vec2;
  /** Pixel where the pointer went down, and where it was last. */
  down: Vec2;
  last: Vec2;
  points: Points;
  index: number;
  moved: boolean;
  line: Vec2[];
}

/** Less than this is a click [px]. */
const SLACK = 3;

let drag: Drag | null = null;
let pending: { at: Vec2; event: PointerEvent } | null = null;
const touches = new Map<number, Vec2>();

export interface Target {
  kind: "vertex" | "segment" | "canvas";
  index: number;
}

export function press(event: PointerEvent, at: Vec2, target: Target): void {
  touches.set(event.pointerId, at);
  if (touches.size === 2) {
    startPinch();
    return;
  }
  if (event.button === 2) return;
  performance.clearMarks();
  const panning = event.button === 1 || spaceHeld.peek();
  spacePanned ||= spaceHeld.peek();
  const kind = panning ? "pan" : dragKind(target);
  drag = {
    kind,
    id: event.pointerId,
    from: toWorld(...at),
    down: at,
    last: at,
    points: drawing.peek().points,
    index: target.index,
    moved: false,
    line: [],
  };
  if (kind === "vertex" && !selection.peek().includes(target.index) && !event.shiftKey) {
    selection.value = [target.index];
  }
  if (kind === "segment" && !event.shiftKey) selection.value = [target.index, target.index + 1];
  dragging.value = kind;
}

function dragKind(target: Target): Drag["kind"] {
  if (tool.peek() !== "select") return "tool";
  return target.kind === "canvas" ? "marquee" : target.kind;
}

/** Browsers that can tell of moves between frames: the service is then asked up to a frame earlier. */
export const MOVE_EVENT = "onpointerrawupdate" in window ? "pointerrawupdate" : "pointermove";

/**
 * The first move since the last frame is applied at once; of those that come before the next one
 * only the newest position is kept, and it is applied with that frame.
 */
export function move(event: PointerEvent, at: Vec2): void {
  if (touches.has(event.pointerId)) touches.set(event.pointerId, at);
  if (touches.size === 2) {
    pinch();
    return;
  }
  if (!drag || event.pointerId !== drag.id) return;
  pending = { at, event };
  if (applied) return;
  apply();
  nextFrame();
}

/** A move was applied for the frame to come. */
let applied = false;

function nextFrame(): void {
  applied = true;
  requestAnimationFrame(() => {
    applied = false;
    if (pending) {
      apply();
      nextFrame();
    }
  });
}

function apply(): void {
  if (!pending || !drag) {
    pending = null;
    return;
  }
  const { at, event } = pending;
  pending = null;
  const far = Math.hypot(at[0] - drag.down[0], at[1] - drag.down[1]) > SLACK;
  if (!drag.moved && !far) return;
  drag.moved = true;
  performance.mark("stairwright:move", { startTime: event.timeStamp });
  stir();
  if (drag.kind === "pan") pan(at[0] - drag.last[0], at[1] - drag.last[1]);
  else if (drag.kind === "marquee") marquee.value = [...drag.down, ...at];
  else if (drag.kind === "tool") drawWith(drag, at, event.altKey);
  else moveWith(drag, at, event);
  drag.last = at;
}

function moveWith(d: Drag, at: Vec2, event: PointerEvent): void {
  const now = toWorld(...at);
  const chosen = selection.peek();
  const anchor = d.points[d.index]!;
  const wish: Vec2 = [anchor[0] + now[0] - d.from[0], anchor[1] + now[1] - d.from[1]];
  if (d.kind === "segment") holdDirection(d, wish);
  const alone = chosen.length <= 1 && !event.shiftKey;
  const snapped = alone
    ? snap(d.points, d.index, wish, view.peek().scale, event.altKey)
    : { at: event.altKey ? wish : ([onGrid(wish[0]), onGrid(wish[1])] as Vec2), x: null, z: null };
  const which = chosen.includes(d.index) ? chosen : [d.index];
  const [x, z] = snapped.at;
  draft({ points: moveVertices(d.points, which, x - anchor[0], z - anchor[1], event.shiftKey) });
  guides.value = snapped;
}

/** A tread moves up and down, a riser back and forth, a slope both ways. */
function holdDirection(d: Drag, wish: Vec2): void {
  const a = d.points[d.index]!;
  const b = d.points[d.index + 1]!;
  if (Math.abs(b[0] - a[0]) < 1e-6) wish[1] = a[1];
  else if (Math.abs(b[1] - a[1]) < 1e-6) wish[0] = a[0];
}

function drawWith(d: Drag, at: Vec2, free: boolean): void {
  const placed = ([x, z]: Vec2): Vec2 => (free ? [x, z] : [onGrid(x), onGrid(z)]);
  const [now, from] = [placed(toWorld(...at)), placed(d.from)];
  const z = heightAt(d.points, from[0]);
  const wide = Math.max(0, now[0] - from[0]);
  const tall = now[1] - z;
  switch (tool.peek()) {
    case "stair": {
      const stair = code.peek();
      if (stair) {
        const steps = Math.min(40, Math.max(1, Math.round(wide / stair.run)));
        const rise = tall < -stair.rise / 2 ? -stair.rise : stair.rise;
        draft({ points: addStairs(d.points, from[0], { rise, run: stair.run }, steps) });
      } else draft({ points: addStairs(d.points, from[0], { rise: tall, run: 0.3 }, 1) });
      break;
    }
    case "ramp":
      draft({ points: addRamp(d.points, from[0], wide, tall) });
      break;
    case "flat":
      draft({ points: addFlat(d.points, from[0], now[0]) });
      break;
    case "free": {
      if (d.line.length === 0) d.line.push(from);
      d.line.push(now);
      draft({
        points: addFree(d.points, d.line, 4 / view.peek().scale, uprightWithin(view.peek().scale)),
      });
      break;
    }
  }
}

/** A click with a tool puts its usual piece there. */
function place(d: Drag): void {
  const x = onGrid(d.from[0]);
  const stair = code.peek() ?? { rise: 0.15, run: 0.3 };
  const which = tool.peek();
  if (which === "free") penCorner([x, onGrid(d.from[1])]);
  if (which === "stair") draft({ points: addStairs(d.points, x, stair, 1) });
  if (which === "ramp") draft({ points: addRamp(d.points, x, 0.6, 0.1) });
  if (which === "flat") draft({ points: addFlat(d.points, x - 0.15, x + 0.15) });
}

export function release(event: PointerEvent): void {
  touches.delete(event.pointerId);
  if (!drag || event.pointerId !== drag.id) return;
  if (pending) apply();
  const d = drag;
  drag = pending = null;
  if (d.kind === "marquee") finishMarquee(d, event.shiftKey);
  else if (!d.moved && d.kind === "vertex" && event.shiftKey) toggleSelected(d.index);
  else if (!d.moved && d.kind === "tool") place(d);
  if (d.kind !== "pan" && d.kind !== "marquee") {
    commit();
    if (d.moved) dismissHint();
  }
  guides.value = null;
  dragging.value = null;
}

/** Escape, or the pointer was taken away: as if the drag had never been. */
export function cancelGesture(): boolean {
  touches.clear();
  const active = drag !== null;
  drag = pending = null;
  marquee.value = null;
  guides.value = null;
  dragging.value = null;
  if (active) revert();
  return active;
}

function toggleSelected(i: number): void {
  const now = selection.peek();
  selection.value = now.includes(i)
    ? now.filter((k) => k !== i)
    : [...now, i].sort((a, b) => a - b);
}

function finishMarquee(d: Drag, add: boolean): void {
  const box = marquee.peek();
  marquee.value = null;
  if (!box || !d.moved) {
    if (!add) selection.value = [];
    return;
  }
  const a = toWorld(box[0], box[1]);
  const b = toWorld(box[2], box[3]);
  const inside = (v: number, p: number, q: number) => (v - p) * (v - q) <= 0;
  const hit = d.points.flatMap((p, i) =>
    inside(p[0], a[0], b[0]) && inside(p[1], a[1], b[1]) ? [i] : [],
  );
  const all = add ? [...selection.peek(), ...hit] : hit;
  selection.value = [...new Set(all)].sort((p, q) => p - q);
}

let pinched: { middle: Vec2; spread: number } | null = null;

function grip(): { middle: Vec2; spread: number } {
  const [a, b] = [...touches.values()] as [Vec2, Vec2];
  return {
    middle: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2],
    spread: Math.max(1, Math.hypot(a[0] - b[0], a[1] - b[1])),
  };
}

function startPinch(): void {
  if (drag) revert();
  drag = pending = null;
  marquee.value = null;
  dragging.value = null;
  pinched = grip();
}

function pinch(): void {
  const now = grip();
  if (pinched) {
    pan(now.middle[0] - pinched.middle[0], now.middle[1] - pinched.middle[1]);
    zoomAt(...now.middle, now.spread / pinched.spread);
  }
  pinched = now;
}

export function splitSegment(i: number, x: number): void {
  const added = addVertex(drawing.peek().points, i, x);
  commit({ points: added.points });
  selection.value = [added.index];
}
