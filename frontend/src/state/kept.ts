/** Choices that this browser remembers from visit to visit. */

import { effect, type Signal, signal } from "@preact/signals";

const name = (key: string) => `stairwright.${key}`;

export function stored(key: string): string | null {
  try {
    return localStorage.getItem(name(key));
  } catch {
    return null;
  }
}

export function store(key: string, value: string): void {
  try {
    localStorage.setItem(name(key), value);
  } catch {
    // Private windows may refuse; the choice then lasts for this page only.
  }
}

/** A signal that begins as it was left; `read` turns what was stored into a value or refuses it. */
export function kept<T extends number | boolean | string>(
  key: string,
  first: T,
  read: (text: string) => T | null,
): Signal<T> {
  const text = stored(key);
  const value = signal<T>((text === null ? null : read(text)) ?? first);
  effect(() => {
    if (value.value !== first || stored(key) !== null) store(key, String(value.value));
  });
  return value;
}

export const readFlag = (text: string): boolean | null =>
  text === "true" ? true : text === "false" ? false : null;

/** A number between two bounds. */
export const readWithin =
  (least: number, most: number) =>
  (text: string): number | null => {
    const value = Number(text);
    return text !== "" && value >= least && value <= most ? value : null;
  };
