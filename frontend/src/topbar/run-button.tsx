/** Run rollout; while it runs, the progress and the way out stand in its place. */

import { connected } from "../state/connection";
import { cancelRollout, canRun, eta, progress, running, startRollout } from "../state/rollouts";
import { Icon } from "../ui/icon";

export function RunButton() {
  if (running.value) {
    const percent = Math.round(progress.value * 100);
    const left = eta.value !== null && eta.value > 1 ? `${Math.round(eta.value)} s left` : null;
    return (
      <div class="btn prog">
        <div
          class="fill"
          role="progressbar"
          aria-label="Rollout"
          aria-valuenow={percent}
          aria-valuemin={0}
          aria-valuemax={100}
          style={{ width: `${percent}%` }}
        />
        <span>
          Running {running.value === "b" && "B "}
          {percent} %{left && <small>{left}</small>}
        </span>
        <button
          type="button"
          class="x"
          onClick={() => {
            cancelRollout();
            // This button goes away: the focus goes to the one that takes its place.
            requestAnimationFrame(() => document.querySelector<HTMLElement>(".top .pri")?.focus());
          }}
        >
          <Icon name="close" />
          Cancel
        </button>
      </div>
    );
  }
  return (
    <button
      type="button"
      class="btn pri"
      disabled={!canRun.value || !connected.value}
      onClick={() => void startRollout()}
    >
      <Icon name="play" fill />
      Run rollout
    </button>
  );
}
