/** The workspace Plan: profile, scene, playback and results, and what the planner weighs. */

import { Inspector } from "../inspector/inspector";
import { plots } from "../parts";
import { Editor } from "../profile-editor/editor";
import { Results } from "../results/results";
import { Scene } from "../scene/scene";
import { DOCK, dock, lastPanel, maximised, SPLIT, type StagePanel, split } from "../state/layout";
import { type Tab, tab } from "../state/view";
import { Transport } from "../transport/transport";
import { Show } from "../ui/part";
import { PoseRow } from "./pose-row";
import { Splitter } from "./splitter";

const TABS: [Tab, string][] = [
  ["editor", "Profile"],
  ["scene", "Scene"],
  ["results", "Results"],
];

/** The key M means the panel that was touched last. */
function noteLast(event: Event): void {
  const panel = (event.target as Element).closest<HTMLElement>("[data-panel]")?.dataset.panel;
  if (panel) lastPanel.value = panel as StagePanel;
}

/** Where a pointer is between the outer edges of the two panels. */
function stageShare(_box: DOMRect, event: PointerEvent): number {
  const panels = [...document.querySelectorAll("[data-panel]")].map((p) =>
    p.getBoundingClientRect(),
  );
  const left = Math.min(...panels.map((p) => p.left));
  const right = Math.max(...panels.map((p) => p.right));
  return (event.clientX - left) / (right - left);
}

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
      <main
        class="work"
        style={{
          "--left": `${split.value * 100}fr`,
          "--right": `${(1 - split.value) * 100}fr`,
          "--dock": dock.value,
        }}
        onPointerOver={noteLast}
        onFocusIn={noteLast}
      >
        <Editor />
        <section class="scene3" aria-label="3-D scene" data-panel="scene">
          <Scene />
        </section>
        {!maximised.value && (
          <Splitter
            upright
            label="Width of profile and scene"
            share={split}
            limits={SPLIT}
            shareAt={stageShare}
          />
        )}
        <Inspector />
        <section class="dock" aria-label="Playback and results">
          <PoseRow />
          <Transport />
          <Splitter
            label="Height of results and plots"
            share={dock}
            limits={DOCK}
            shareAt={(box, event) => (box.bottom - event.clientY) / innerHeight}
            grows={false}
          />
          <Results />
          <Show part={plots} />
        </section>
      </main>
    </>
  );
}
