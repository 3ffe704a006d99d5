/** Presets, saved terrains, saving, generators and files. */

import type { ComponentChildren } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { ImportProblem } from "../import/import-problem";
import { importProblem, takeFile } from "../import/take";
import { readTerrains } from "../state/catalogue";
import { report } from "../state/connection";
import { clear, drawing, isEmpty } from "../state/drawing";
import { terrains } from "../state/setup";
import { pointsOpen } from "../state/view";
import { Icon } from "../ui/icon";
import { Menu } from "../ui/menu";
import { NameField } from "../ui/name-field";
import { GenerateForm } from "./generate-form";
import {
  openStored,
  removeStored,
  saveAs,
  saveError,
  suggestedDescription,
  suggestedName,
} from "./terrain-actions";

export function TerrainMenu({ button }: { button: ComponentChildren }) {
  return (
    <Menu
      label="Terrain"
      named
      button={button}
      buttonClass="fld"
      panelClass="terrains"
      kind="dialog"
    >
      {(close) => <TerrainPanel close={close} />}
    </Menu>
  );
}

function TerrainPanel({ close }: { close: () => void }) {
  const file = useRef<HTMLInputElement>(null);
  // Other windows and people save terrains, too.
  useEffect(() => void readTerrains().catch(report), []);
  const [generating, setGenerating] = useState(false);
  const presets = terrains.value.filter((t) => t.readonly);
  const saved = terrains.value.filter((t) => !t.readonly);
  if (generating) return <GenerateForm back={() => setGenerating(false)} close={close} />;
  return (
    <>
      <SaveForm close={close} />
      <div class="acts">
        <button
          type="button"
          class="act"
          onClick={() => {
            clear();
            close();
          }}
        >
          <Icon name="plus" />
          New
        </button>
        <button type="button" class="act" onClick={() => setGenerating(true)}>
          <Icon name="stair" />
          Generate
        </button>
        <button type="button" class="act" onClick={() => file.current?.click()}>
          <Icon name="upload" />
          Import
        </button>
        <button
          type="button"
          class="act"
          disabled={isEmpty.value}
          onClick={() => {
            close();
            pointsOpen.value = true;
          }}
        >
          <Icon name="table" />
          Points
        </button>
        <input
          ref={file}
          type="file"
          hidden
          aria-label="Terrain file"
          accept=".csv,.txt,.json,.yaml,.yml,.stl,.obj,.ply,.off"
          onChange={async (event) => {
            const input = event.currentTarget;
            const chosen = input.files?.[0];
            if (chosen && (await takeFile(chosen, "menu"))) close();
            // The same file, mended, can be chosen again.
            else input.value = "";
          }}
        />
      </div>
      <ImportProblem place="menu" />
      <div class="lists">
        {saved.length > 0 && <h4>Saved</h4>}
        {saved.map((terrain) => (
          <div class="row" key={terrain.name}>
            <button
              type="button"
              class="item"
              aria-pressed={terrain.name === drawing.value.name}
              onClick={() => choose(terrain, close)}
            >
              <span class="two" title={terrain.name}>
                <span class="name">{terrain.name}</span>
                <small>{terrain.description}</small>
              </span>
            </button>
            <button
              type="button"
              class="t ico"
              aria-label={`Delete ${terrain.name}`}
              title={`Delete ${terrain.name}`}
              onClick={() => void removeStored(terrain)}
            >
              <Icon name="trash" />
            </button>
          </div>
        ))}
        <h4>Presets</h4>
        {presets.map((terrain) => (
          <button
            key={terrain.name}
            type="button"
            class="item"
            aria-pressed={terrain.name === drawing.value.name}
            onClick={() => choose(terrain, close)}
          >
            <span class="two">
              {terrain.name}
              <small>{terrain.description}</small>
            </span>
          </button>
        ))}
      </div>
    </>
  );
}

function choose(terrain: Parameters<typeof openStored>[0], close: () => void): void {
  openStored(terrain);
  close();
}

function SaveForm({ close }: { close: () => void }) {
  const [name, setName] = useState(suggestedName);
  const [about, setAbout] = useState(suggestedDescription);
  // What failed the last time is not about this attempt.
  useEffect(() => {
    saveError.value = null;
    importProblem.value = null;
  }, []);
  const save = async (event: Event) => {
    event.preventDefault();
    if (await saveAs(name.trim(), about.trim())) close();
  };
  return (
    <form class="save" onSubmit={save}>
      <NameField value={name} onChange={setName} />
      <button type="submit" class="btn" disabled={isEmpty.value}>
        <Icon name="save" />
        Save
      </button>
      <label class="about">
        <span>Description</span>
        <input
          value={about}
          maxLength={500}
          placeholder="none"
          onInput={(event) => setAbout(event.currentTarget.value)}
        />
      </label>
      {saveError.value && (
        <p class="error" role="alert">
          {saveError.value}
        </p>
      )}
    </form>
  );
}
