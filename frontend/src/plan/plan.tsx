/** The workspace Plan: profile, scene, playback and results, and what the planner weighs. */

import { Inspector } from "../inspector/inspector";
import { Plots } from "../plots/plots";
import { Editor } from "../profile-editor/editor";
import { Results } from "../results/results";
import { Scene } from "../scene/scene";
import { type Tab, tab } from "../state/view";
import { Transport } from "../transport/transport";

const TABS: [Tab, string][] = [
  ["editor", "Profile"],
  ["scene", "Scene"],
  ["results", "Results"],
];

export function Plan() {
  return (
    <>
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
    </>
  );
}
