/** Files dropped anywhere, text pasted anywhere. */

import { signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { droppedRobot } from "../state/dropped";
import { workspace } from "../state/workspace";
import { Icon } from "../ui/icon";
import { takeFile, takeText } from "./take";

const hovering = signal(false);

const ROBOT = /\.(urdf|mjcf|xml|zip)$/i;

/** A robot's file goes to its room, everything else is a profile. */
function take(file: File): void {
  if (!ROBOT.test(file.name)) {
    void takeFile(file, "page");
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
      take(file);
    };
    const paste = (event: ClipboardEvent) => {
      if (isField(event.target)) return;
      const file = event.clipboardData?.files[0];
      const text = event.clipboardData?.getData("text/plain") ?? "";
      if (file) take(file);
      else if (text.trim()) takeText(text, "page");
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
        CSV, JSON or YAML points, an STL or OBJ mesh; URDF, MJCF or zip
      </div>
    </div>
  );
}
