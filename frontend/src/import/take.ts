/** Profiles from outside: files dropped or chosen, text pasted. What is wrong is said where it was. */

import { signal } from "@preact/signals";
import { importTerrain } from "../api/client";
import { capital } from "../geometry/format";
import { report } from "../state/connection";
import { show } from "../topbar/terrain-actions";
import { startCut } from "./cut";
import { wrongWith } from "./wrong";

/** Where the user is while importing: the whole page, the terrain menu, or the table of points. */
export type Place = "page" | "menu" | "table";

/** Why nothing was imported. */
export const importProblem = signal<{ place: Place; text: string } | null>(null);

const MESH = /\.(stl|obj|ply|off)$/i;

/** A dropped or chosen file; a mesh asks for a plane first. Whether it is taken. */
export async function takeFile(file: File, place: Place): Promise<boolean> {
  importProblem.value = null;
  if (MESH.test(file.name)) {
    startCut(file);
    return true;
  }
  try {
    show(await importTerrain(await terrainIn(file), {}), null);
    return true;
  } catch (error) {
    report(error);
    const text = `${file.name} is not imported. ${sentence(wrongWith(error))}`;
    importProblem.value = { place, text };
    return false;
  }
}

function sentence(text: string): string {
  return `${capital(text)}${text.endsWith(".") ? "" : "."}`;
}

/** Plans and rollouts hold the terrain that they are for; any other file is taken as it is. */
async function terrainIn(file: File): Promise<File> {
  if (!/\.json$/i.test(file.name)) return file;
  try {
    const document = JSON.parse(await file.text());
    if (!/^stairwright\/(plan|rollout)\//.test(document.schema) || !document.terrain) return file;
    return new File([JSON.stringify(document.terrain)], file.name, { type: file.type });
  } catch {
    // What is wrong with it is for the service to say.
    return file;
  }
}
