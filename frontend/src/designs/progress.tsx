/** How far the shown search is, how long it will take, and how to stop it or go on. */

import { count, remaining, WorkBar, WorkButtons } from "../map/work";
import { refusal } from "./form";
import { goOn, pause, searching, shownState, start } from "./state";

export function SearchProgress() {
  const state = shownState.value;
  return (
    <section class="prog-map">
      <WorkButtons
        atWork={searching.value}
        state={state?.state}
        run={start}
        pause={pause}
        goOn={goOn}
      />
      {refusal.value && (
        <p class="error" role="alert" ref={(shown) => shown?.scrollIntoView({ block: "nearest" })}>
          {refusal.value}
        </p>
      )}
      {state?.state && state.state !== "done" && (
        <>
          <WorkBar label="Designs of the search" done={state.progress * 100} total={100} />
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
