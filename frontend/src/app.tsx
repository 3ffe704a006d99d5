/** The page: one screen of four areas. */

import { useEffect } from "preact/hooks";
import { Inspector } from "./inspector/inspector";
import { Plots } from "./plots/plots";
import { onPageKey, onPageKeyUp } from "./profile-editor/commands";
import { Editor } from "./profile-editor/editor";
import { Results } from "./results/results";
import { Scene } from "./scene/scene";
import { assertive, polite } from "./state/announce";
import { connected } from "./state/connection";
import { isEmpty } from "./state/drawing";
import { plan, refusal, stale } from "./state/planning";
import { activity, run } from "./state/rollouts";
import { inspectorOpen, swapped, type Tab, tab } from "./state/view";
import { Status } from "./status";
import { ImportZone } from "./topbar/import-zone";
import { TopBar } from "./topbar/topbar";
import { Transport } from "./transport/transport";
import { Toast } from "./ui/toast";

const TABS: [Tab, string][] = [
  ["editor", "Profile"],
  ["scene", "Scene"],
  ["results", "Results"],
];

/** In one word, for style sheets and tests. */
function planState(): string {
  if (isEmpty.value) return "none";
  if (refusal.value) return "refused";
  return stale.value || !plan.value ? "planning" : plan.value.status;
}

export function App() {
  useEffect(() => {
    addEventListener("keydown", onPageKey);
    addEventListener("keyup", onPageKeyUp);
    return () => {
      removeEventListener("keydown", onPageKey);
      removeEventListener("keyup", onPageKeyUp);
    };
  }, []);
  return (
    <div
      class="app"
      data-offline={connected.value ? undefined : ""}
      data-swapped={swapped.value ? "" : undefined}
      data-inspector={inspectorOpen.value ? "open" : "shut"}
      data-tab={tab.value}
      data-plan={planState()}
      data-run={activity.value === "idle" ? (run.value?.outcome ?? "none") : activity.value}
    >
      <TopBar />
      <nav class="tabs" aria-label="Areas">
        {TABS.map(([name, title]) => (
          <button
            key={name}
            type="button"
            aria-pressed={tab.value === name}
            onClick={() => {
              tab.value = name;
            }}
          >
            {title}
          </button>
        ))}
      </nav>
      <main class="work">
        <Editor />
        <section class="scene3" aria-label="3-D scene">
          <Scene />
        </section>
        <Inspector />
        <section class="dock" aria-label="Playback and results">
          <Transport />
          <Results />
          <Plots />
        </section>
      </main>
      <Status />
      <ImportZone />
      <Toast />
      <div class="sr" aria-live="polite">
        {polite.value}
      </div>
      <div class="sr" role="alert">
        {assertive.value}
      </div>
    </div>
  );
}
