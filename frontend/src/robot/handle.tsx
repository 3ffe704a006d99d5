/** What a hand or a key can take hold of in the side view. */

import type { ComponentChildren } from "preact";
import type { Vec2 } from "../api/types";
import { fixed } from "../geometry/format";
import { robotDocument } from "../state/setup";
import { finish, selected, set } from "./edit";
import { type Quantity, quantityOf } from "./quantities";

/** What a finger can hit [px]. */
export const TARGET = 24;

interface HandleProps {
  id: string;
  class: string;
  onHold: (at: Vec2) => void;
  children: ComponentChildren;
}

/** As it stands on screen, with its unit. */
export const told = (q: Quantity, value: number) =>
  `${fixed(value * q.factor, q.digits)} ${q.unit}`;

/** Where an event is in its drawing [px]. */
export function placeIn(event: MouseEvent): Vec2 {
  const svg = (event.currentTarget as Element).closest("svg")!;
  const box = svg.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}

/** Bring the quantity's field in the table under the fingers. */
function type(id: string): void {
  document.querySelector<HTMLInputElement>(`[data-quantity="${id}"] input`)?.focus();
}

const STEPS: Record<string, number> = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1 };

export function Handle({ id, class: kind, onHold, children }: HandleProps) {
  const file = robotDocument.value;
  const q = quantityOf(id);
  const value = file && q.read(file);
  if (value === null) return null;
  const onKeyDown = (event: KeyboardEvent) => {
    const steps = STEPS[event.key];
    if (event.key === "Enter") {
      event.preventDefault();
      type(id);
    } else if (steps) {
      event.preventDefault();
      event.stopPropagation();
      selected.value = id;
      set(id, value + steps * q.step * (event.shiftKey ? 10 : event.altKey ? 0.1 : 1));
    }
  };
  return (
    <g
      class={`handle ${kind}${selected.value === id ? " sel" : ""}`}
      data-handle={id}
      role="slider"
      tabindex={0}
      aria-label={q.label}
      aria-valuenow={Number((value * q.factor).toFixed(4))}
      aria-valuemin={Number((q.min * q.factor).toFixed(4))}
      aria-valuemax={Number((q.max * q.factor).toFixed(4))}
      aria-valuetext={told(q, value)}
      onPointerDown={(event) => {
        event.preventDefault();
        event.currentTarget.focus({ preventScroll: true });
        event.currentTarget.closest("svg")!.setPointerCapture(event.pointerId);
        onHold(placeIn(event));
      }}
      onDblClick={() => type(id)}
      onKeyDown={onKeyDown}
      onBlur={finish}
    >
      {children}
    </g>
  );
}
