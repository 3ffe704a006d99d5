/** Opening, saving, importing and making terrains. */

import { signal } from "@preact/signals";
import {
  deleteTerrain,
  generateTerrain,
  getTerrains,
  importTerrain,
  putTerrain,
} from "../api/client";
import type { TerrainDocument } from "../api/types";
import { fit } from "../profile-editor/viewport";
import { report } from "../state/connection";
import { committed, drawing, open, origin, terrainDocument } from "../state/drawing";
import { forgetRollout } from "../state/rollouts";
import { terrains } from "../state/setup";
import { toast } from "../state/toast";
import { tool } from "../state/view";

/** What went wrong with a file or a name; shown where it happened. */
export const terrainError = signal<string | null>(null);
/** Why a terrain was not saved; the menu shows it below the name. */
export const saveError = signal<string | null>(null);
/** A mesh that waits for the plane to cut it along. */
export const meshToCut = signal<File | null>(null);

function show(terrain: TerrainDocument, stored: TerrainDocument | null): void {
  terrainError.value = null;
  forgetRollout();
  open(terrain, stored);
  tool.value = "select";
  fit(terrain.points);
}

export function openStored(terrain: TerrainDocument): void {
  show(terrain, terrain);
}

function fail(error: unknown): void {
  report(error);
  terrainError.value = error instanceof Error ? error.message : String(error);
}

/** Save the drawing; what it replaces can be brought back. */
export async function saveAs(name: string, description: string): Promise<boolean> {
  const before = terrains.peek().find((t) => t.name === name && !t.readonly);
  try {
    const saved = await putTerrain({ ...terrainDocument(committed.peek()), name, description });
    terrains.value = await getTerrains();
    origin.value = terrains.peek().find((t) => t.name === saved.name) ?? saved;
    drawing.value = { ...drawing.peek(), name: saved.name, description };
    committed.value = drawing.peek();
    saveError.value = null;
    toast.value = before
      ? { text: `${name} is replaced.`, undo: () => void putBack(before, false) }
      : { text: `Saved as ${name}.` };
    return true;
  } catch (error) {
    report(error);
    saveError.value = error instanceof Error ? error.message : String(error);
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
    terrains.value = await getTerrains();
    const opened = origin.peek()?.name === name;
    if (opened) origin.value = null;
    toast.value = { text: `${name} is deleted.`, undo: () => void putBack(terrain, opened) };
  } catch (error) {
    fail(error);
  }
}

async function putBack(terrain: TerrainDocument, opened: boolean): Promise<void> {
  try {
    await putTerrain(terrain);
    terrains.value = await getTerrains();
    if (opened && drawing.peek().name === terrain.name) origin.value = terrain;
  } catch (error) {
    fail(error);
  }
}

export async function generate(parameters: Record<string, unknown>): Promise<boolean> {
  try {
    show(await generateTerrain(parameters), null);
    return true;
  } catch (error) {
    fail(error);
    return false;
  }
}

const MESH = /\.(stl|obj)$/i;

/** A dropped or chosen file; meshes ask for a plane first. */
export async function takeFile(file: File): Promise<void> {
  if (MESH.test(file.name)) meshToCut.value = file;
  else await importFile(await terrainIn(file), {});
}

/** A plan holds the terrain that it is for; any other file is taken as it is. */
async function terrainIn(file: File): Promise<File> {
  if (!/\.json$/i.test(file.name)) return file;
  try {
    const document = JSON.parse(await file.text());
    if (!/^stairwright\/plan\//.test(document.schema) || !document.terrain) return file;
    return new File([JSON.stringify(document.terrain)], file.name, { type: file.type });
  } catch {
    // What is wrong with it is for the service to say.
    return file;
  }
}

export async function importFile(file: File, fields: Record<string, string>): Promise<boolean> {
  try {
    show(await importTerrain(file, fields), null);
    return true;
  } catch (error) {
    fail(error);
    return false;
  }
}

/** Pasted text becomes a file whose ending says what it looks like. */
export function takeText(text: string): void {
  const trimmed = text.trim();
  const ending = /^[{[]/.test(trimmed)
    ? "json"
    : /(^|\n)\s*points\s*:/.test(trimmed)
      ? "yaml"
      : "csv";
  void takeFile(new File([trimmed], `pasted.${ending}`, { type: "text/plain" }));
}
