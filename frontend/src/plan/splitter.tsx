/** A bar between two areas: drag, arrow keys, double click for the middle. */

import type { Signal } from "@preact/signals";
import type { Limits } from "../state/layout";

interface Props {
  label: string;
  /** Of the bar itself: an upright bar moves sideways. */
  upright?: boolean;
  share: Signal<number>;
  limits: Limits;
  /** The share that a pointer means, of an area's box and its place in the page. */
  shareAt: (box: DOMRect, event: PointerEvent) => number;
  /** Whether arrow right or down makes the share larger. */
  grows?: boolean;
}

const STEP = 0.02;
const LEAP = 0.1;

export function Splitter({ label, upright, share, limits, shareAt, grows = true }: Props) {
  const { least, most, first } = limits;
  const set = (value: number) => {
    share.value = Math.min(most, Math.max(least, value));
  };
  const onPointerMove = (event: PointerEvent) => {
    if (event.buttons !== 1) return;
    const bar = event.currentTarget as HTMLElement;
    set(shareAt(bar.parentElement!.getBoundingClientRect(), event));
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const along = upright ? ["ArrowLeft", "ArrowRight"] : ["ArrowUp", "ArrowDown"];
    const way = along.indexOf(event.key);
    if (way >= 0) {
      const by = (event.shiftKey ? LEAP : STEP) * ((way === 1) === grows ? 1 : -1);
      set(share.peek() + by);
    } else if (event.key === "Home") set(least);
    else if (event.key === "End") set(most);
    else if (event.key === "Enter") set(first);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  return (
    <div
      class={upright ? "split upright" : "split"}
      role="separator"
      tabIndex={0}
      aria-label={label}
      aria-orientation={upright ? "vertical" : "horizontal"}
      aria-valuemin={Math.round(least * 100)}
      aria-valuemax={Math.round(most * 100)}
      aria-valuenow={Math.round(share.value * 100)}
      title={`${label}: drag, or arrow keys; double click resets`}
      onPointerDown={(event) => {
        if (event.button === 0) event.currentTarget.setPointerCapture(event.pointerId);
      }}
      onPointerMove={onPointerMove}
      onDblClick={() => set(first)}
      onKeyDown={onKeyDown}
    />
  );
}
