/** A study or a search at work: how to begin it, stop it and go on, how far it is, what is left. */

import { about, fixed } from "../geometry/format";
import { Icon } from "../ui/icon";

interface WorkButtonsProps {
  atWork: boolean;
  /** Of what is shown; nothing where the service knows of none. */
  state: string | null | undefined;
  run: () => unknown;
  pause: () => unknown;
  goOn: () => unknown;
}

export function WorkButtons({ atWork, state, run, pause, goOn }: WorkButtonsProps) {
  return (
    <div class="acts">
      <button type="button" class="btn pri" onClick={() => void run()}>
        <Icon name="play" fill />
        Run
      </button>
      {atWork && (
        <button type="button" class="btn" onClick={() => void pause()}>
          Pause
        </button>
      )}
      {["cancelled", "failed"].includes(state ?? "") && (
        <button type="button" class="btn" onClick={() => void goOn()}>
          Go on
        </button>
      )}
    </div>
  );
}

interface WorkBarProps {
  label: string;
  done: number;
  total: number;
}

export function WorkBar({ label, done, total }: WorkBarProps) {
  return (
    <div
      class="bar-map"
      role="progressbar"
      aria-label={label}
      aria-valuemin={0}
      aria-valuemax={total}
      aria-valuenow={Math.round(done)}
    >
      <i style={{ width: `${fixed(total > 0 ? (done / total) * 100 : 0, 1)}%` }} />
    </div>
  );
}

export const count = (n: number) => n.toLocaleString("en-US");

/** What is left of it, in words. */
export function remaining(state: string, eta: number | null, stays: string): string {
  if (state === "queued") return "waiting for its turn";
  if (state === "cancelled") return `paused, ${stays}`;
  if (state === "done") return "done";
  if (state === "failed") return "stopped";
  return eta === null ? "measuring the pace" : `${about(eta)} left`;
}
