/** What answers a moving hand in time, by measurement: the full method, or the quick one first. */

import type { Plan } from "../api/types";

/** A full answer within this needs no preview: at 60 frames a second it is two frames [ms]. */
const FRAMES = 30;
/** The quick method pays only where it takes less than this share of the full one's time. */
const SHARE = 0.6;
/** Newer measurements count for this much. */
const FRESH = 0.4;
/** With each full answer the quick method's time is believed this much less: it is tried again. */
const FADE = 0.8;

export class Pace {
  private full = 0;
  private quick = 0;
  /** The quick method found poses the last time: it is worth waiting for its next answer. */
  finds = true;

  /** Measured round trips [ms]; an answer out of a cache counts as what it took to solve. */
  measured(kind: "full" | "quick", trip: number, answer: Plan): void {
    const took = Math.max(trip, answer.solve_time * 1000);
    const before = this[kind];
    this[kind] = before === 0 ? took : before + FRESH * (took - before);
    if (kind === "full") this.quick *= FADE;
  }

  get worthPreview(): boolean {
    return this.full > FRAMES && this.quick < SHARE * this.full;
  }
}
