/** The upright plane that a mesh is cut along, and the profile that it gives, asked for as it moves. */

import { computed, signal } from "@preact/signals";
import { importTerrain, lookAtMesh } from "../api/client";
import { NewestWins } from "../api/newest-wins";
import type { MeshHeights, TerrainDocument, Vec2 } from "../api/types";
import { show } from "../topbar/terrain-actions";
import { wrongWith } from "./wrong";

export type Up = "z" | "y";

/** How to read the file, and where to cut what it holds. */
export interface Cut {
  up: Up;
  /** Metres per unit of the file. */
  scale: number;
  /** A point of the plane, seen from above: the profile's x is zero there [m]. */
  through: Vec2;
  /** Direction of travel, counter-clockwise from +x [rad]. */
  heading: number;
}

export const meshFile = signal<File | null>(null);
/** The mesh seen from above, in units of the file. */
export const heights = signal<MeshHeights | null>(null);
export const cut = signal<Cut>({ up: "z", scale: 1, through: [0, 0], heading: 0 });
export const profile = signal<TerrainDocument | null>(null);
export const cutProblem = signal<string | null>(null);
/** The profile answers the plane as it lies now. */
export const upToDate = signal(false);

/** Farther than a terrain may reach [m]. */
const FAR = 100;
const MILLIMETRE = 0.001;

/** Edges of the mesh from above: least and most x, least and most y [m]. */
export const extent = computed<[Vec2, Vec2] | null>(() => {
  const seen = heights.value;
  const { scale } = cut.value;
  return (
    seen && [
      [seen.low[0] * scale, seen.high[0] * scale],
      [seen.low[1] * scale, seen.high[1] * scale],
    ]
  );
});

interface Question {
  file: File;
  cut: Cut;
}

const asked = new NewestWins<Question, TerrainDocument>({
  solve: ({ file, cut: { up, scale, through, heading } }, signal) =>
    importTerrain(
      file,
      {
        up,
        scale: String(scale),
        x: String(through[0]),
        y: String(through[1]),
        heading: String(heading),
      },
      signal,
    ),
  show: (answer, _question, newest) => {
    profile.value = answer;
    cutProblem.value = null;
    upToDate.value = newest;
  },
  fail: (error, _question, newest) => {
    if (!newest) return;
    profile.value = null;
    cutProblem.value = wrongWith(error);
  },
  yields: () => false,
});

export function startCut(file: File): void {
  heights.value = null;
  profile.value = null;
  cutProblem.value = null;
  meshFile.value = file;
  void look("z");
}

/** See the mesh from above, and lay the plane through its middle; its x stays where it can. */
async function look(up: Up): Promise<void> {
  const file = meshFile.peek();
  if (!file) return;
  upToDate.value = false;
  try {
    const seen = await lookAtMesh(file, up);
    if (file !== meshFile.peek()) return;
    const size = Math.max(...seen.high.map((most, i) => most - seen.low[i]!));
    const scale = size > 2 * FAR ? MILLIMETRE : 1;
    const middle = (i: 0 | 1) => (scale * (seen.low[i] + seen.high[i])) / 2;
    const within = scale * Math.max(Math.abs(seen.low[0]), Math.abs(seen.high[0])) <= FAR;
    heights.value = seen;
    lay({ up, scale, through: [within ? 0 : middle(0), middle(1)], heading: 0 });
  } catch (error) {
    if (file !== meshFile.peek()) return;
    heights.value = null;
    profile.value = null;
    cutProblem.value = wrongWith(error);
  }
}

export function turnUp(up: Up): void {
  cut.value = { ...cut.peek(), up };
  void look(up);
}

function lay(next: Cut): void {
  const file = meshFile.peek();
  if (!file) return;
  cut.value = next;
  upToDate.value = false;
  asked.ask({ file, cut: next });
}

const MILLIMETRES = 1000;
const round = (v: number) => Math.round(v * MILLIMETRES) / MILLIMETRES;

/** Another place, direction or unit, whatever is given. */
export function move(part: Partial<Omit<Cut, "up">>): void {
  const next = { ...cut.peek(), ...part };
  // A place in the mesh stays the same place in another unit.
  const grown = next.scale / cut.peek().scale;
  lay({ ...next, through: [round(next.through[0] * grown), round(next.through[1] * grown)] });
}

/** Shift the plane sideways until it passes through a point [m]. */
export function moveThrough([x, y]: Vec2): void {
  const { through, heading } = cut.peek();
  const normal: Vec2 = [-Math.sin(heading), Math.cos(heading)];
  const by = normal[0] * (x - through[0]) + normal[1] * (y - through[1]);
  move({ through: [through[0] + by * normal[0], through[1] + by * normal[1]] });
}

const HALF_DEGREE = Math.PI / 360;

/** Turn the plane towards a point [m], by half degrees. */
export function pointAt([x, y]: Vec2): void {
  const { through } = cut.peek();
  const angle = Math.atan2(y - through[1], x - through[0]);
  move({ heading: Math.round(angle / HALF_DEGREE) * HALF_DEGREE });
}

export function closeCut(): void {
  asked.forget();
  meshFile.value = null;
}

/** Take the profile over as it is shown. */
export function takeCut(): void {
  const found = profile.peek();
  if (!found || !upToDate.peek()) return;
  closeCut();
  show(found, null);
}
