/** The workspace Robot: what it is, every number of it, and what it climbs beside another one. */

import { useSignalEffect } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { isField } from "../profile-editor/commands";
import { redo, undo } from "../state/drawing";
import { droppedRobot } from "../state/dropped";
import { giveUp } from "./drag";
import { Library } from "./library";
import { Numbers } from "./numbers";
import { Preview } from "./preview";
import { readFile } from "./shelf";
import { SideView } from "./side-view";
import { Toolbar } from "./toolbar";

function onKey(event: KeyboardEvent): void {
  if (isField(event.target) || event.defaultPrevented) return;
  if (event.key === "Escape") giveUp();
  if (!(event.ctrlKey || event.metaKey)) return;
  const key = event.key.toLowerCase();
  if (key === "z" || key === "y") {
    event.preventDefault();
    if (key === "y" || event.shiftKey) redo();
    else undo();
  }
}

export function RobotRoom() {
  useEffect(() => {
    addEventListener("keydown", onKey);
    return () => removeEventListener("keydown", onKey);
  }, []);
  useSignalEffect(() => {
    const file = droppedRobot.value;
    if (!file) return;
    droppedRobot.value = null;
    void readFile(file);
  });
  return (
    <main class="robot-room">
      <Library />
      <section class="bench" aria-label="Side view">
        <Toolbar />
        <SideView />
      </section>
      <Numbers />
      <Preview />
    </main>
  );
}
