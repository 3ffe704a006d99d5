/** One sentence about what has just happened, and the way back where there is one. */

import { signal } from "@preact/signals";

export interface Toast {
  text: string;
  undo?: () => void;
}

export const toast = signal<Toast | null>(null);
