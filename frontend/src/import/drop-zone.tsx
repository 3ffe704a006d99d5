/** Files dropped anywhere, text pasted anywhere. */

import { signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { droppedRobot } from "../state/dropped";
import { workspace } from "../state/workspace";
import { Icon } from "../ui/icon";
import { holdsRobot, pastedFile } from "./kind";
import { takeFile } from "./take";

const hovering = signal(false);

/** A robot's file goes to its room, everything else is a profile. */
async function take(file: File): Promise<void> {
  if (!(await holdsRobot(file))) {
    await takeFile(file, "page");
    return;
  }
  droppedRobot.value = file;
  workspace.value = "robot";
}

const isField = (target: EventTarget | null) =>
  target instanceof HTMLElement && /^(INPUT|TEXTAREA)$/.test(target.tagName);

export function DropZone() {
  useEffect(() => {
    const hasFile = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;
    const over = (event: DragEvent) => {
      if (!hasFile(event)) return;
      event.preventDefault();
      hovering.value = true;
    };
    const leave = (event: DragEvent) => {
      if (event.relatedTarget === null) hovering.value = false;
    };
    const drop = (event: DragEvent) => {
      hovering.value = false;
      const file = event.dataTransfer?.files[0];
      if (!file) return;
      event.preventDefault();
      void take(file);
    };
    const paste = (event: ClipboardEvent) => {
      if (isField(event.target)) return;
      const file = event.clipboardData?.files[0];
      const text = event.clipboardData?.getData("text/plain") ?? "";
      if (file) void take(file);
      else if (text.trim()) void take(pastedFile(text));
    };
    addEventListener("dragover", over);
    addEventListener("dragleave", leave);
    addEventListener("drop", drop);
    addEventListener("paste", paste);
    return () => {
      removeEventListener("dragover", over);
      removeEventListener("dragleave", leave);
      removeEventListener("drop", drop);
      removeEventListener("paste", paste);
    };
  }, []);
  if (!hovering.value) return null;
  return (
    <div class="dropzone" aria-hidden="true">
      <div>
        <Icon name="upload" />
        <b>Drop a profile or a robot</b>
        Points in CSV, JSON or YAML, an STL or OBJ mesh; a robot in URDF, MJCF, zip or YAML
      </div>
    </div>
  );
}
