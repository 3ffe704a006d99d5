/** How far the shown search is, how long it will take, and how to stop it or go on. */

import { fixed } from "../geometry/format";
import { count, remaining } from "../map/progress";
import { Icon } from "../ui/icon";
import { refusal } from "./form";
import { goOn, pause, searching, shownState, start } from "./state";

export function SearchProgress() {
  const state = shownState.value;
  return (
    <section class="prog-map">
      <div class="acts">
        <button type="button" class="btn pri" onClick={() => void start()}>
          <Icon name="play" fill />
          Run
        </button>
        {searching.value && (
          <button type="button" class="btn" onClick={() => void pause()}>
            Pause
          </button>
        )}
        {["cancelled", "failed"].includes(state?.state ?? "") && (
          <button type="button" class="btn" onClick={() => void goOn()}>
            Go on
          </button>
        )}
      </div>
      {refusal.value && (
        <p class="error" role="alert" ref={(shown) => shown?.scrollIntoView({ block: "nearest" })}>
          {refusal.value}
        </p>
      )}
      {state?.state && state.state !== "done" && (
        <>
          <div
            class="bar-map"
            role="progressbar"
            aria-label="Designs of the search"
            aria-valuemin={0}
            aria-valuemax={100}
            aria-valuenow={Math.round(state.progress * 100)}
          >
            <i style={{ width: `${fixed(state.progress * 100, 1)}%` }} />
          </div>
          <p class="sub">
            {count(state.tried)} of {count(state.designs)} designs;{" "}
            {state.stage || remaining(state.state, state.eta, "what was tried stays")}
          </p>
        </>
      )}
      {state?.error && state.state === "failed" && (
        <p class="error">{String(state.error.detail ?? state.error.title)}</p>
      )}
    </section>
  );
}
