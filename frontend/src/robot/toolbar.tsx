/** Over the side view: what it shows, the way back, and where the robot goes from here. */

import { useState } from "preact/hooks";
import { canRedo, canUndo, redo, undo } from "../state/drawing";
import { robotDocument, robotName, robots, settings, storedRobot } from "../state/setup";
import { Icon } from "../ui/icon";
import { IconButton } from "../ui/icon-button";
import { Menu, MenuItem } from "../ui/menu";
import { NameField } from "../ui/name-field";
import { changed, edited, posture, resetRobot } from "./edit";
import { download, saveAs, shelfError } from "./shelf";
import { LAYERS, type Layer, shown, toggle } from "./view";

function state(): string {
  const count = changed.value.size;
  if (count > 0) return `edited, ${count} ${count === 1 ? "number" : "numbers"}`;
  const stored = storedRobot.value;
  if (!stored) return "not saved";
  if (edited.value) return "edited";
  return stored.readonly ? "preset" : "yours";
}

export function Toolbar() {
  return (
    <header class="hd">
      <h2 title={robotDocument.value?.description}>
        {robotName.value} <small>{state()}</small>
      </h2>
      <div class="grow" />
      {(Object.keys(LAYERS) as Layer[]).map((layer) => (
        <button
          key={layer}
          type="button"
          class={shown.value.has(layer) ? "t on" : "t"}
          aria-pressed={shown.value.has(layer)}
          onClick={() => toggle(layer)}
        >
          {LAYERS[layer]}
        </button>
      ))}
      <div class="sep" />
      <IconButton action={undo} label="Undo" icon="undo" off={!canUndo.value} />
      <IconButton action={redo} label="Redo" icon="redo" off={!canRedo.value} />
      <button
        type="button"
        class="t ico"
        aria-label="Reset robot"
        title="Reset all its numbers"
        disabled={!edited.value && !posture.value}
        onClick={resetRobot}
      >
        <Icon name="reset" />
      </button>
      <Files />
      <Save />
    </header>
  );
}

function Files() {
  const formats = settings.value?.exports.robot ?? [];
  return (
    <Menu
      label="Download robot"
      button={<Icon name="download" />}
      buttonClass="t ico"
      panelClass="downloads"
      align="right"
    >
      {(close) => (
        <>
          <div class="head">Robot</div>
          {formats.map(({ name, note }) => (
            <MenuItem
              key={name}
              onChoose={() => {
                void download(name);
                close();
              }}
            >
              <b>{name.toUpperCase()}</b>
              <small>{note}</small>
            </MenuItem>
          ))}
        </>
      )}
    </Menu>
  );
}

function Save() {
  return (
    <Menu
      label="Save as"
      named
      button="Save as"
      buttonClass="btn"
      panelClass="save-robot"
      kind="dialog"
      align="right"
    >
      {(close) => <SaveForm close={close} />}
    </Menu>
  );
}

/** A preset keeps its name to itself: a changed one is saved under another. */
function suggestion(): string {
  const name = robotName.peek();
  return robots.peek().some((r) => r.name === name && r.readonly) ? `${name}-mine` : name;
}

function SaveForm({ close }: { close: () => void }) {
  const [name, setName] = useState(suggestion);
  const save = async (event: Event) => {
    event.preventDefault();
    if (await saveAs(name.trim())) close();
  };
  return (
    <form class="save" onSubmit={save}>
      <NameField value={name} onChange={setName} />
      <button type="submit" class="btn pri">
        Save
      </button>
      {shelfError.value && (
        <p class="error" role="alert">
          {shelfError.value}
        </p>
      )}
    </form>
  );
}
