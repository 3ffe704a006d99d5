/** A toolbar is one stop of the Tab key; arrows walk its buttons. */

import type { RefObject } from "preact";
import { useLayoutEffect, useRef } from "preact/hooks";

type Item = HTMLElement | SVGElement;

const SETTLED = 100; // ms; who is drawn makes the browser lay out the page: not at each move of a drag
const BUTTONS = "button:not([disabled]), a[href]";

const items = (bar: Item, of: string) =>
  [...bar.querySelectorAll<Item>(of)].filter(
    (each) => !each.closest(".panel") && each.getClientRects().length > 0,
  );

function tend(bar: Item, of: string): void {
  const all = items(bar, of);
  const active = document.activeElement as Item;
  const one = all.includes(active) ? active : (all.find((each) => each.tabIndex === 0) ?? all[0]);
  for (const each of all) each.tabIndex = each === one ? 0 : -1;
}

export function useRoving(root: RefObject<Item | null>, of = BUTTONS): void {
  const tended = useRef<Item | null>(null);
  // After each render: what can be pressed may be another.
  useLayoutEffect(() => {
    const bar = root.current;
    if (!bar) return;
    // Chromium makes SVG that listens for the focus a stop of its own.
    if (bar instanceof SVGElement) bar.tabIndex = -1;
    const later = tended.current === bar ? setTimeout(() => tend(bar, of), SETTLED) : undefined;
    if (later === undefined) tend(bar, of);
    tended.current = bar;
    const onFocus = () => tend(bar, of);
    const onKey = (raw: Event) => {
      const event = raw as KeyboardEvent;
      const all = items(bar, of);
      const at = all.indexOf(event.target as Item);
      const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: -1 }[event.key];
      if (at < 0 || to === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      all.at(to >= all.length ? 0 : to)?.focus();
    };
    bar.addEventListener("focusin", onFocus);
    bar.addEventListener("keydown", onKey);
    return () => {
      clearTimeout(later);
      bar.removeEventListener("focusin", onFocus);
      bar.removeEventListener("keydown", onKey);
    };
  });
}
