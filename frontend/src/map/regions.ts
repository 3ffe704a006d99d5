/** Where the robot is stopped: areas of one reason, their borders, and a place for their letter. */

import { type Field, STOPPED } from "./cube";
import type { Point } from "./shapes";

export interface Region {
  reason: string;
  cells: number;
  /** The place deepest inside, in cells. */
  at: Point;
  /** Width of the region through that place, in cells. */
  width: number;
}

/** Connected areas of one reason each, largest first. */
export function regions(field: Field): Region[] {
  const { nx, ny } = field;
  const seen = new Uint8Array(nx * ny);
  const found: Region[] = [];
  for (let start = 0; start < nx * ny; start++) {
    if (seen[start] || field.verdict[start] !== STOPPED) continue;
    const reason = field.reason[start]!;
    const area: number[] = [];
    const open = [start];
    seen[start] = 1;
    for (let here = open.pop(); here !== undefined; here = open.pop()) {
      area.push(here);
      for (const next of neighbours(here, nx, ny)) {
        if (seen[next] || field.verdict[next] !== STOPPED) continue;
        if (field.reason[next] !== reason) continue;
        seen[next] = 1;
        open.push(next);
      }
    }
    found.push(placed(reason, area, field));
  }
  return found.sort((a, b) => b.cells - a.cells);
}

function neighbours(here: number, nx: number, ny: number): number[] {
  const [i, j] = [here % nx, Math.floor(here / nx)];
  const out: number[] = [];
  if (i > 0) out.push(here - 1);
  if (i + 1 < nx) out.push(here + 1);
  if (j > 0) out.push(here - nx);
  if (j + 1 < ny) out.push(here + nx);
  return out;
}

/** The middle of the widest run of the region, nearest to its centre of gravity. */
function placed(reason: string, area: readonly number[], { nx }: Field): Region {
  const rows = new Map<number, number[]>();
  for (const here of area) {
    const j = Math.floor(here / nx);
    rows.set(j, [...(rows.get(j) ?? []), here % nx]);
  }
  const centre = area.reduce((sum, here) => sum + Math.floor(here / nx), 0) / area.length;
  let best = { at: [0, 0] as Point, width: 0, score: -Infinity };
  for (const [j, columns] of rows) {
    columns.sort((a, b) => a - b);
    for (let from = 0; from < columns.length; ) {
      let to = from;
      while (columns[to + 1] === columns[to]! + 1) to += 1;
      const width = to - from + 1;
      const score = Math.min(width, 8) - 0.7 * Math.abs(j - centre);
      if (score > best.score) best = { at: [(columns[from]! + columns[to]!) / 2, j], width, score };
      from = to + 1;
    }
  }
  return { reason, cells: area.length, at: best.at, width: best.width };
}

/** Lines between cells that differ in verdict or reason, in cells; corners of cells are at .5. */
export function borders(field: Field): Point[][] {
  const { nx, ny, verdict, reason } = field;
  const kind = (here: number) => (verdict[here] === STOPPED ? `!${reason[here]}` : verdict[here]);
  const lines: Point[][] = [];
  for (let j = 0; j < ny; j++) {
    for (let i = 0; i < nx; i++) {
      const here = j * nx + i;
      const differs = (there: number) =>
        kind(here) !== kind(there) &&
        (verdict[here] === STOPPED || verdict[there] === STOPPED) &&
        verdict[here] !== 0 &&
        verdict[there] !== 0;
      if (i + 1 < nx && differs(here + 1))
        lines.push([
          [i + 0.5, j - 0.5],
          [i + 0.5, j + 0.5],
        ]);
      if (j + 1 < ny && differs(here + nx))
        lines.push([
          [i - 0.5, j + 0.5],
          [i + 0.5, j + 0.5],
        ]);
    }
  }
  return lines;
}
