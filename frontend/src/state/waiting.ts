/** How long the newest question has waited for its answer, once that is worth telling. */

import { signal } from "@preact/signals";

/** Shorter waits show no spinner: it would only flicker [ms]. */
const PATIENCE = 150;

/** The newest question has waited for longer than anyone would overlook. */
export const slow = signal(false);
export const waited = signal(0);

let timer: ReturnType<typeof setTimeout> | undefined;
let ticker: ReturnType<typeof setInterval> | undefined;

export function startWaiting(): void {
  if (timer) return;
  const since = performance.now();
  timer = setTimeout(() => {
    slow.value = true;
    waited.value = PATIENCE / 1000;
    ticker = setInterval(() => {
      waited.value = (performance.now() - since) / 1000;
    }, 100);
  }, PATIENCE);
}

export function stopWaiting(): void {
  clearTimeout(timer);
  clearInterval(ticker);
  timer = undefined;
  slow.value = false;
}
