/** Where a number comes from: its file, an assumption, or a hand on this page. */

import { robotDocument } from "../state/setup";
import { base, changed } from "./edit";
import type { Quantity } from "./quantities";

export type Mark = "source" | "assumed" | "edited";

export interface Marked {
  mark: Mark;
  /** A few words beside the number, and the whole sentence. */
  note: string;
  text: string;
}

export const TITLES: Record<Mark, string> = {
  source: "from source",
  assumed: "assumed",
  edited: "edited",
};

export function markOf(q: Quantity, show: (value: number) => string): Marked {
  const file = robotDocument.value;
  const before = base.value;
  if (changed.value.has(q.id)) {
    const value = before ? q.read(before) : null;
    const was = value === null ? "new" : `was ${show(value)}`;
    return { mark: "edited", note: was, text: `Edited here, ${was}` };
  }
  const sentence = file?.assumed_fields?.[q.path];
  if (sentence !== undefined) {
    return { mark: "assumed", note: "assumed", text: `Assumed: ${file!.assumed![sentence]}` };
  }
  return {
    mark: "source",
    note: "",
    text: file?.source || file?.description || "The robot's file",
  };
}
