/** How far the study is, how long it will take, and how to stop it or go on. */

import { fixed } from "../geometry/format";
import { Icon } from "../ui/icon";
import { atWork, cancel, resume, start, study } from "./state";

export function Progress() {
  const state = study.value;
  return (
    <section class="prog-map">
      <div class="acts">
        <button type="button" class="btn pri" onClick={() => void start()}>
          <Icon name="play" fill />
          Run
        </button>
        {atWork.value && (
          <button type="button" class="btn" onClick={() => void cancel()}>
            Pause
          </button>
        )}
        {state && ["cancelled", "failed"].includes(state.state) && (
          <button type="button" class="btn" onClick={() => void resume()}>
            Go on
          </button>
        )}
      </div>
      {state && <Bar />}
    </section>
  );
}

function Bar() {
  const state = study.value!;
  const share = state.total > 0 ? state.done / state.total : 0;
  return (
    <>
      <div
        class="bar-map"
        role="progressbar"
        aria-label="Cells of the map"
        aria-valuemin={0}
        aria-valuemax={state.total}
        aria-valuenow={state.done}
      >
        <i style={{ width: `${fixed(share * 100, 1)}%` }} />
      </div>
      <p class="sub">
        {count(state.done)} of {count(state.total)} cells;{" "}
        {state.stage || remaining(state.state, state.eta, "what was computed stays")}
      </p>
      {state.outdated && (
        <p class="sub">
          By an earlier version of the planner. <b>Run</b> computes it anew.
        </p>
      )}
      {state.error && <p class="error">{String(state.error.detail ?? state.error.title)}</p>}
    </>
  );
}

export const count = (n: number) => n.toLocaleString("en-US");

/** What is left of it, in words. */
export function remaining(state: string, eta: number | null, stays: string): string {
  if (state === "queued") return "waiting for its turn";
  if (state === "cancelled") return `paused, ${stays}`;
  if (state === "done") return "done";
  if (state === "failed") return "stopped";
  return eta === null ? "measuring the pace" : `${left(eta)} left`;
}

/** Remaining time, no finer than it is known. */
function left(seconds: number): string {
  if (seconds < 60) return `about ${Math.max(1, Math.ceil(seconds / 5) * 5)} s`;
  if (seconds < 3600) return `about ${Math.ceil(seconds / 60)} min`;
  return `about ${fixed(seconds / 3600, 1)} h`;
}
