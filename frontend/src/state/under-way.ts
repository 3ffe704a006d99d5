/** The jobs that this tab waits for: the service goes on with them, so after a reload it waits on. */

import { getJob } from "../api/client";
import { plan, settled } from "./planning";

type Kind = "rollout" | "trials";

export interface UnderWay {
  job: string;
  /** The plan that is driven. */
  plan: string;
}

const name = (kind: Kind) => `stairwright.under-way.${kind}`;

/** Remember what is under way; null once it is over. */
export function remember<T extends UnderWay>(kind: Kind, what: T | null): void {
  try {
    if (what) sessionStorage.setItem(name(kind), JSON.stringify(what));
    else sessionStorage.removeItem(name(kind));
  } catch {
    // A browser that keeps nothing forgets it at a reload.
  }
}

/** What was under way when the page was left, if the service has it and the plan is still shown. */
export async function wasUnderWay<T extends UnderWay>(kind: Kind): Promise<T | null> {
  try {
    const what = JSON.parse(sessionStorage.getItem(name(kind)) ?? "null") as T | null;
    if (!what) return null;
    const { state } = await getJob(what.job);
    await settled();
    const ended = state === "failed" || state === "cancelled";
    return ended || plan.peek()?.id !== what.plan ? null : what;
  } catch {
    return null;
  }
}
