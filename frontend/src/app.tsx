/** The page: top bar, the open workspace, status line. */

import { computed } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { closeCut, meshFile } from "./import/cut";
import { DropZone } from "./import/drop-zone";
import { ImportProblem } from "./import/import-problem";
import { cutDialog, pointsTable } from "./parts";
import { Plan } from "./plan/plan";
import { isField, onPageKey, onPageKeyUp } from "./profile-editor/commands";
import { assertive, polite } from "./state/announce";
import { connected } from "./state/connection";
import { isEmpty } from "./state/drawing";
import { inspectorOpen, maximised, swapped } from "./state/layout";
import { plan, refusal, stale } from "./state/planning";
import { activity, run } from "./state/rollouts";
import { pointsOpen, tab } from "./state/view";
import { Status } from "./status";
import { TopBar } from "./topbar/topbar";
import { Show } from "./ui/part";
import { Shortcuts, shortcutsOpen } from "./ui/shortcuts";
import { SkipLinks } from "./ui/skip-links";
import { Toast } from "./ui/toast";
import { openByKey, openRoom } from "./workspaces";

/** In one word, for style sheets and tests. */
const planState = computed(() => {
  if (isEmpty.value) return "none";
  if (refusal.value) return "refused";
  return stale.value || !plan.value ? "planning" : plan.value.status;
});

/** The number keys choose a workspace, all others belong to Plan while it is open. */
function onKey(event: KeyboardEvent): void {
  if (isField(event.target) || event.defaultPrevented) return;
  if (shortcutsOpen.peek()) return;
  if (event.key === "?") {
    shortcutsOpen.value = true;
    return;
  }
  const plain = !(event.ctrlKey || event.metaKey || event.altKey);
  if (!(plain && openByKey(event.key)) && openRoom().name === "plan") onPageKey(event);
}

function closePoints(): void {
  pointsOpen.value = false;
}

export function App() {
  useEffect(() => {
    addEventListener("keydown", onKey);
    addEventListener("keyup", onPageKeyUp);
    return () => {
      removeEventListener("keydown", onKey);
      removeEventListener("keyup", onPageKeyUp);
    };
  }, []);
  const open = openRoom();
  return (
    <div
      class="app"
      data-workspace={open.name}
      data-offline={connected.value ? undefined : ""}
      data-swapped={swapped.value ? "" : undefined}
      data-max={maximised.value ?? undefined}
      data-inspector={inspectorOpen.value ? "open" : "shut"}
      data-tab={tab.value}
      data-plan={planState}
      data-run={activity.value === "idle" ? (run.value?.outcome ?? "none") : activity.value}
    >
      {open.name === "plan" && <SkipLinks />}
      <TopBar />
      <div class="room" hidden={open.name !== "plan"}>
        <Plan />
      </div>
      {open.part && (
        <div class="room">
          <Show key={open.name} part={open.part} />
        </div>
      )}
      <Status />
      <DropZone />
      {meshFile.value && <Show part={cutDialog} giveUp={closeCut} />}
      <ImportProblem place="page" />
      {pointsOpen.value && <Show part={pointsTable} giveUp={closePoints} />}
      <Shortcuts />
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
