/** Whether the service answers, and how fast; retries by itself when it does not. */

import { signal } from "@preact/signals";
import { Offline, ping } from "../api/client";

export const connected = signal(true);
/** Round trip of the last heartbeat [ms]. */
export const latency = signal<number | null>(null);
/** Seconds until the next attempt, while disconnected. */
export const retryIn = signal(0);

const HEARTBEAT = 5000;
const WAITS = [1, 2, 3, 5, 5, 8];

let attempts = 0;
let timer: ReturnType<typeof setTimeout> | undefined;
let onReturn: () => void = () => undefined;

/** Start the heartbeat; `back` runs each time the service has returned. */
export function watchConnection(back: () => void): void {
  onReturn = back;
  void beat();
}

/** Every failed call reports here; only "no answer at all" counts as disconnected. */
export function report(error: unknown): void {
  if (error instanceof Offline) lost();
}

export function retryNow(): void {
  clearTimeout(timer);
  void beat();
}

async function beat(): Promise<void> {
  try {
    latency.value = await ping();
    attempts = 0;
    if (!connected.peek()) {
      connected.value = true;
      onReturn();
    }
    clearTimeout(timer);
    timer = setTimeout(beat, HEARTBEAT);
  } catch {
    lost();
    countDown(WAITS[Math.min(attempts++, WAITS.length - 1)]!);
  }
}

function lost(): void {
  if (!connected.peek()) return;
  connected.value = false;
  attempts = 0;
  countDown(WAITS[0]!);
}

function countDown(seconds: number): void {
  clearTimeout(timer);
  retryIn.value = seconds;
  timer = setTimeout(() => (seconds <= 1 ? void beat() : countDown(seconds - 1)), 1000);
}
