/** Removing with time to think again: gone from the screen at once, from the service later. */

import { type ReadonlySignal, signal } from "@preact/signals";
import { BASE } from "../api/client";
import { report } from "./connection";
import { toast } from "./toast";

/** Time to think again before something is removed for good [ms]. */
const GRACE = 8000;

interface Removable<T> {
  /** Its address below that of the interface. */
  path: (item: T) => string;
  /** What a sentence calls it. */
  title: (item: T) => string;
  /** The service has it no longer; when this is done, no list has it any more. */
  gone: (item: T) => void | Promise<void>;
}

export interface Removal<T> {
  /** Removed on screen; the service is told when there is no way back any more. */
  doomed: ReadonlySignal<ReadonlyMap<string, T>>;
  /** @param back is called where it is spared after all */
  remove: (item: T, back?: () => void) => void;
}

export function removal<T extends { id: string }>(of: Removable<T>): Removal<T> {
  const doomed = signal<ReadonlyMap<string, T>>(new Map());

  function spare(id: string): void {
    const left = new Map(doomed.peek());
    left.delete(id);
    doomed.value = left;
  }

  /** Outlives the page, which may be closing. */
  const tell = (item: T) =>
    fetch(`${BASE}/${of.path(item)}`, { method: "DELETE", keepalive: true });

  async function finish(item: T): Promise<void> {
    try {
      const answer = await tell(item);
      if (!answer.ok && answer.status !== 404) throw new Error(`the service said ${answer.status}`);
      await of.gone(item);
    } catch (error) {
      report(error);
      toast.value = { text: `${of.title(item)} could not be deleted.` };
    }
    spare(item.id);
  }

  function remove(item: T, back?: () => void): void {
    doomed.value = new Map(doomed.peek()).set(item.id, item);
    const timer = setTimeout(() => void finish(item), GRACE);
    const shown = {
      text: `${of.title(item)} is deleted.`,
      undo: () => {
        clearTimeout(timer);
        spare(item.id);
        back?.();
      },
    };
    toast.value = shown;
    setTimeout(() => {
      if (toast.peek() === shown) toast.value = null;
    }, GRACE);
  }

  addEventListener("pagehide", () => {
    for (const item of doomed.peek().values()) void tell(item);
  });
  return { doomed, remove };
}
