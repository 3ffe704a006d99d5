/** What both panels of the stage end their header with: swap and maximise. */

import { maximise, maximised, type StagePanel, swapped } from "../state/layout";
import { Icon } from "../ui/icon";

export function PanelTools({ panel, title }: { panel: StagePanel; title: string }) {
  const alone = maximised.value === panel;
  return (
    <span class="stage-tools">
      {!alone && (
        <button
          type="button"
          class="t ico"
          aria-label="Swap profile and scene"
          title="Swap profile and scene (X)"
          aria-keyshortcuts="X"
          aria-pressed={swapped.value}
          onClick={() => {
            swapped.value = !swapped.value;
          }}
        >
          <Icon name="swap" />
        </button>
      )}
      <button
        type="button"
        class="t ico"
        aria-label={alone ? "Show both panels" : `Maximise the ${title}`}
        title={alone ? "Show both panels (M or Escape)" : `Maximise the ${title} (M)`}
        aria-keyshortcuts="M"
        aria-pressed={alone}
        onClick={() => maximise(panel)}
      >
        <Icon name={alone ? "restore" : "maximise"} />
      </button>
    </span>
  );
}
