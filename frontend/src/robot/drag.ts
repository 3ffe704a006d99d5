/** Pulling at the side view: one drag is one step in the history, Escape gives it up. */

import type { RobotDocument, Vec2 } from "../api/types";
import { held } from "../state/drawing";
import { robotDocument } from "../state/setup";
import { draft, finish, posture, selected } from "./edit";
import { clamped, quantityOf } from "./quantities";
import { frame, projection } from "./view";

/** With Alt a hand moves a number a tenth as far, in tenths of a step. */
const FINE = 0.1;

/** A quantity that follows the pointer along a direction on screen. */
interface Pull {
  id: string;
  direction: Vec2;
  gain: number;
}

interface Held {
  from: Vec2;
  file: RobotDocument;
  move: (at: Vec2, fine: boolean) => void;
  release: () => void;
}

let inHand: Held | null = null;

function take(next: Held): void {
  inHand = next;
  held.value = true;
}

const onGrid = (value: number, step: number) =>
  Number((Math.round(value / step) * step).toFixed(9));

/** Take hold of one dimension, or of a place with two. */
export function hold(pulls: readonly Pull[], from: Vec2): void {
  const file = robotDocument.peek();
  if (!file) return;
  selected.value = pulls[0]!.id;
  const { scale } = projection.peek();
  take({
    from,
    file,
    move: (at, fine) => {
      performance.mark("stairwright:move");
      let next = file;
      for (const { id, direction, gain } of pulls) {
        const q = quantityOf(id);
        const way = (at[0] - from[0]) * direction[0] + (at[1] - from[1]) * direction[1];
        const step = fine ? q.step * FINE : q.step;
        const value = (q.read(file) ?? 0) + (gain * (fine ? FINE : 1) * way) / scale;
        next = q.write(next, clamped(q, onGrid(value, step)));
      }
      draft(next);
    },
    release: finish,
  });
}

/** Angle of a joint whose link points to `at` on screen; nearest to the one before. */
function angleTo(joint: Vec2, at: Vec2, zero: number, near: number): number {
  const angle = Math.atan2(-(at[0] - joint[0]), at[1] - joint[1]) - zero;
  const turn = 2 * Math.PI;
  return angle + turn * Math.round((near - angle) / turn);
}

/** Take hold of a tick at the end of a joint's range. */
export function holdLimit(id: string, joint: Vec2, zero: number, from: Vec2): void {
  const file = robotDocument.peek();
  if (!file) return;
  selected.value = id;
  const q = quantityOf(id);
  let value = q.read(file) ?? 0;
  take({
    from,
    file,
    move: (at, fine) => {
      const step = fine ? q.step * FINE : q.step;
      value = angleTo(joint, at, zero, value);
      draft(q.write(file, clamped(q, onGrid(value, step))));
    },
    release: finish,
  });
}

/** Take hold of the dot at a joint's angle: poses the leg, and changes nothing of the robot. */
export function holdJoint(index: number, joint: Vec2, zero: number, range: Vec2, from: Vec2): void {
  const file = robotDocument.peek();
  const start = frame.peek()?.q;
  if (!file || !start) return;
  let value = start[index]!;
  take({
    from,
    file,
    move: (at) => {
      value = angleTo(joint, at, zero, value);
      const q = [...start];
      q[index] = Math.min(range[1], Math.max(range[0], value));
      posture.value = q;
    },
    release: () => undefined,
  });
}

export function pull(at: Vec2, fine: boolean): void {
  inHand?.move(at, fine);
}

export function letGo(): void {
  held.value = false;
  inHand?.release();
  inHand = null;
}

/** Back to how it was when the hand took hold. */
export function giveUp(): void {
  if (!inHand) return;
  draft(inHand.file);
  inHand = null;
  held.value = false;
}
