/** The sentence at the foot of the page; it stays until it is dismissed or another one comes. */

import { toast } from "../state/toast";
import { Icon } from "./icon";

export function Toast() {
  const shown = toast.value;
  const dismiss = () => {
    toast.value = null;
  };
  return (
    <div role="status">
      {shown && (
        <div class="toast tag">
          <span>{shown.text}</span>
          {shown.undo && (
            <button
              type="button"
              class="btn"
              onClick={() => {
                dismiss();
                shown.undo?.();
              }}
            >
              Undo
            </button>
          )}
          <button type="button" class="t ico" aria-label="Dismiss" onClick={dismiss}>
            <Icon name="close" />
          </button>
        </div>
      )}
    </div>
  );
}
