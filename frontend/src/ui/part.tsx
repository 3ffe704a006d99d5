/** Parts of the page whose code comes when they are first opened, or before that while it idles. */

import { type Signal, signal } from "@preact/signals";
import type { ComponentType } from "preact";
import { useEffect } from "preact/hooks";

export class Part {
  readonly view: Signal<ComponentType | null> = signal(null);
  readonly failed = signal(false);
  private coming: Promise<void> | null = null;

  /** `title` is what people call it: "The map". */
  constructor(
    readonly title: string,
    private readonly load: () => Promise<ComponentType>,
  ) {}

  /** Fetch it unless it is there or on its way; whether that worked is in `view` and `failed`. */
  fetch(): Promise<void> {
    this.coming ??= this.load().then(
      (found) => {
        this.view.value = found;
        this.failed.value = false;
      },
      () => {
        this.failed.value = true;
        this.coming = null; // a later attempt may have better luck
      },
    );
    return this.coming;
  }
}

/** Safari does not tell when it idles. */
const whenIdle: (then: () => void) => void =
  "requestIdleCallback" in window
    ? (then) => requestIdleCallback(then, { timeout: 2000 })
    : (then) => setTimeout(then, 200);

/** Fetch them one after the other, so that opening them later waits for nothing. */
export function fetchWhileIdle(parts: readonly Part[]): void {
  const [next, ...others] = parts;
  if (next) whenIdle(() => void next.fetch().then(() => fetchWhileIdle(others)));
}

interface ShowProps {
  part: Part;
  /** What closes it, where it can be done without. */
  giveUp?: () => void;
}

/** The part; until it is there, that it is coming, or that it did not come. */
export function Show({ part, giveUp }: ShowProps) {
  useEffect(() => void part.fetch(), [part]);
  const View = part.view.value;
  if (View) return <View />;
  if (!part.failed.value) return <div class="part coming">Loading…</div>;
  return (
    <div class="part" role="alert">
      <p>{part.title} could not be loaded. The service may be gone, or have been renewed.</p>
      <div class="acts">
        {giveUp && (
          <button type="button" class="btn" onClick={giveUp}>
            Close
          </button>
        )}
        <button type="button" class="btn" onClick={() => location.reload()}>
          Reload the page
        </button>
        <button type="button" class="btn pri" onClick={() => void part.fetch()}>
          Try again
        </button>
      </div>
    </div>
  );
}
