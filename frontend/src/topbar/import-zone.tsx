/** Files dropped anywhere, text pasted anywhere, and the plane that cuts a mesh. */

import { signal } from "@preact/signals";
import { useEffect, useRef, useState } from "preact/hooks";
import { fixed, setting } from "../geometry/format";
import { readFile } from "../robot/shelf";
import { workspace } from "../state/workspace";
import { Icon } from "../ui/icon";
import { NumberField } from "../ui/number-field";
import { importFile, meshToCut, takeFile, takeText, terrainError } from "./terrain-actions";

const hovering = signal(false);

const ROBOT = /\.(urdf|mjcf|xml|zip)$/i;

/** A robot's file goes to its room, everything else is a profile. */
function take(file: File): void {
  if (!ROBOT.test(file.name)) {
    void takeFile(file);
    return;
  }
  workspace.value = "robot";
  void readFile(file);
}

const isField = (target: EventTarget | null) =>
  target instanceof HTMLElement && /^(INPUT|TEXTAREA)$/.test(target.tagName);

export function ImportZone() {
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
      else if (text.trim()) takeText(text);
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
  return (
    <>
      {hovering.value && (
        <div class="dropzone" aria-hidden="true">
          <div>
            <Icon name="upload" />
            <b>Drop a profile or a robot</b>
            CSV, JSON or YAML points, an STL or OBJ mesh; URDF, MJCF or zip
          </div>
        </div>
      )}
      {meshToCut.value && <CutDialog file={meshToCut.value} />}
      {terrainError.value && !meshToCut.value && <ImportError />}
    </>
  );
}

function ImportError() {
  const dismiss = () => {
    terrainError.value = null;
  };
  return (
    <div class="import-error tag" role="alert">
      <Icon name="warning" />
      <span>{terrainError.value}</span>
      <button type="button" class="t ico" aria-label="Dismiss" onClick={dismiss}>
        <Icon name="close" />
      </button>
    </div>
  );
}

/** Where to cut the mesh: an upright plane along x at some y, turned about z. */
function CutDialog({ file }: { file: File }) {
  const dialog = useRef<HTMLDialogElement>(null);
  const [y, setY] = useState<number | null>(null);
  const [scale, setScale] = useState(1);
  const [heading, setHeading] = useState(0);
  useEffect(() => dialog.current?.showModal(), []);
  const close = () => {
    meshToCut.value = null;
    terrainError.value = null;
  };
  const submit = async (event: Event) => {
    event.preventDefault();
    const fields = {
      heading: String((heading * Math.PI) / 180),
      scale: String(scale),
      ...(y === null ? {} : { y: String(y) }),
    };
    if (await importFile(file, fields)) close();
  };
  return (
    <dialog ref={dialog} class="tag cut" aria-labelledby="cut-title" onClose={close}>
      <form onSubmit={submit}>
        <h2 id="cut-title">Cut {file.name} into a profile</h2>
        <p>
          An upright plane through the mesh; its upper edge becomes the ground. z is up, metres.
        </p>
        <div class="frow">
          <span>Plane at y, m</span>
          <NumberField
            label="Plane at y in metres"
            value={y ?? 0}
            min={-1000}
            max={1000}
            step={0.05}
            format={(v) => fixed(v, 3)}
            onChange={setY}
          />
        </div>
        <div class="frow">
          <span>Heading about z, °</span>
          <NumberField
            label="Heading in degrees"
            value={heading}
            min={-180}
            max={180}
            step={5}
            format={(v) => fixed(v, 1)}
            onChange={setHeading}
          />
        </div>
        <div class="frow">
          <span>Metres per unit</span>
          <NumberField
            label="Metres per unit of the file"
            value={scale}
            min={0.0001}
            max={1000}
            format={setting}
            onChange={setScale}
          />
        </div>
        {terrainError.value && (
          <p class="error" role="alert">
            {terrainError.value}
          </p>
        )}
        <div class="acts end">
          <button type="button" class="btn" onClick={close}>
            Cancel
          </button>
          <button type="submit" class="btn pri">
            Import
          </button>
        </div>
      </form>
    </dialog>
  );
}
