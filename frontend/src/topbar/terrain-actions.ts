/** Opening, saving and making terrains. */

import { signal } from "@preact/signals";
import { deleteTerrain, generateTerrain, getTerrains, putTerrain, reasonOf } from "../api/client";
import type { TerrainDocument } from "../api/types";
import { fit } from "../profile-editor/viewport";
import { readTerrains } from "../state/catalogue";
import { report } from "../state/connection";
import { committed, drawing, open, origin, storedAs, terrainDocument } from "../state/drawing";
import { forgetRollout } from "../state/rollouts";
import { terrains } from "../state/setup";
import { toast } from "../state/toast";
import { tool } from "../state/view";

/** Why nothing was generated; the form shows it. */
export const generateError = signal<string | null>(null);
/** Why a terrain was not saved; the menu shows it below the name. */
export const saveError = signal<string | null>(null);

/** Draw a terrain, which may be the stored one of that name. */
export function show(terrain: TerrainDocument, from: string | null): void {
  forgetRollout();
  open(terrain, from);
  tool.value = "select";
  fit(terrain.points);
}

export function openStored(terrain: TerrainDocument): void {
  show(terrain, terrain.name);
}

/** Save the drawing; what it replaces can be brought back. */
export async function saveAs(name: string, description: string): Promise<boolean> {
  try {
    // Another window may have saved it meanwhile.
    const before = (await getTerrains()).find((t) => t.name === name && !t.readonly);
    const saved = await putTerrain({ ...terrainDocument(committed.peek()), name, description });
    await readTerrains();
    storedAs(saved.name, description);
    saveError.value = null;
    toast.value = before
      ? { text: `${name} is replaced.`, undo: () => void putBack(before) }
      : { text: `Saved as ${name}.` };
    return true;
  } catch (error) {
    report(error);
    saveError.value = reasonOf(error);
    return false;
  }
}

/** A preset keeps its name to itself: a changed one is saved under another. */
export function suggestedName(): string {
  const { name } = drawing.peek();
  const taken = terrains.peek().some((t) => t.name === name && t.readonly);
  return taken || name === "Untitled" ? `${name === "Untitled" ? "terrain" : name}-mine` : name;
}

/** A preset's description is of the preset, not of what was made of it. */
export const suggestedDescription = (): string =>
  origin.peek()?.readonly ? "" : drawing.peek().description;

/** Ctrl+S: under its own name, or a preset's with an ending. */
export async function save(): Promise<void> {
  if (drawing.peek().points.length < 2) return;
  if (!(await saveAs(suggestedName(), suggestedDescription())))
    toast.value = { text: `Not saved: ${saveError.peek()}` };
}

export async function removeStored(terrain: TerrainDocument): Promise<void> {
  const { name } = terrain;
  try {
    await deleteTerrain(name);
    await readTerrains();
    toast.value = { text: `${name} is deleted.`, undo: () => void putBack(terrain) };
  } catch (error) {
    report(error);
    toast.value = { text: `${name} is not deleted: ${reasonOf(error)}` };
  }
}

async function putBack(terrain: TerrainDocument): Promise<void> {
  try {
    await putTerrain(terrain);
    await readTerrains();
  } catch (error) {
    report(error);
    toast.value = { text: `${terrain.name} is not back: ${reasonOf(error)}` };
  }
}

export async function generate(parameters: Record<string, unknown>): Promise<boolean> {
  generateError.value = null;
  try {
    show(await generateTerrain(parameters), null);
    return true;
  } catch (error) {
    report(error);
    generateError.value = reasonOf(error);
    return false;
  }
}
