/** Run rollout; while it runs, the progress and the way out stand in its place. */

import type { RefObject } from "preact";
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";
import { connected } from "../state/connection";
import { cancelRollout, canRun, eta, progress, running, startRollout } from "../state/rollouts";
import { Icon } from "../ui/icon";

/** Where run and cancel take each other's place, the focus goes along. */
function useFocusKept(): RefObject<HTMLButtonElement | null> {
  const button = useRef<HTMLButtonElement>(null);
  const kept = useRef(false);
  // Before the drawing: the button that goes away may have the focus still.
  if (button.current && document.activeElement === button.current) kept.current = true;
  useLayoutEffect(() => {
    const now = document.activeElement;
    if (kept.current && (now === document.body || now === null)) button.current?.focus();
    // One that cannot be pressed yet takes it when it can, unless the user has gone elsewhere.
    const at = document.activeElement;
    kept.current &&= at === document.body || at === button.current;
  });
  useEffect(() => {
    const leave = () => {
      kept.current = false;
    };
    addEventListener("pointerdown", leave, true);
    return () => removeEventListener("pointerdown", leave, true);
  }, []);
  return button;
}

export function RunButton() {
  const button = useFocusKept();
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
        <button key="cancel" ref={button} type="button" class="x" onClick={cancelRollout}>
          <Icon name="close" />
          Cancel
        </button>
      </div>
    );
  }
  return (
    <button
      key="run"
      ref={button}
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
