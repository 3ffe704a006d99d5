/** How far the study is, how long it will take, and how to stop it or go on. */

import { atWork, cancel, resume, start, study } from "./state";
import { count, remaining, WorkBar, WorkButtons } from "./work";

export function Progress() {
  const state = study.value;
  return (
    <section class="prog-map">
      <WorkButtons
        atWork={atWork.value}
        state={state?.state}
        run={start}
        pause={cancel}
        goOn={resume}
      />
      {state && (
        <>
          <WorkBar label="Cells of the map" done={state.done} total={state.total} />
          <p class="sub">
            {count(state.done)} of {count(state.total)} cells;{" "}
            {state.stage || remaining(state.state, state.eta, "what was computed stays")}
          </p>
          {state.outdated && (
            <p class="sub">
              By an earlier version of the planner. <b>Run</b> computes it anew.
            </p>
          )}
          {state.error && state.state === "failed" && (
            <p class="error">{String(state.error.detail ?? state.error.title)}</p>
          )}
        </>
      )}
    </section>
  );
}
