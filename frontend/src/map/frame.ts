/** Where the parts of a map lie on its canvas [px], and which cell a point belongs to. */

export interface Panel {
  x: number;
  y: number;
  w: number;
  h: number;
  nx: number;
  ny: number;
}

export interface Frame {
  width: number;
  height: number;
  panels: readonly Panel[];
  /** Top of the legend. */
  legend: number;
}

export interface Place {
  panel: number;
  i: number;
  j: number;
}

const LEFT = 58;
const RIGHT = 18;
const BOTTOM = 92;
const GAP = 18;

export function frameOf(
  width: number,
  height: number,
  nx: number,
  ny: number,
  count: number,
  titled: boolean,
): Frame {
  const top = titled ? 34 : 14;
  const inner = width - LEFT - RIGHT - GAP * (count - 1);
  const w = Math.max(20, inner / count);
  const h = Math.max(20, height - top - BOTTOM);
  const panels = Array.from({ length: count }, (_, k) => ({
    x: LEFT + k * (w + GAP),
    y: top,
    w,
    h,
    nx,
    ny,
  }));
  return { width, height, panels, legend: height - 40 };
}

/** Pixel of a place along x, in cells; 0 is the centre of the first. */
export const toX = (p: Panel, i: number): number => p.x + ((i + 0.5) * p.w) / p.nx;
/** The same along y; the lowest row is at the bottom. */
export const toY = (p: Panel, j: number): number => p.y + p.h - ((j + 0.5) * p.h) / p.ny;

export function placeAt(frame: Frame, x: number, y: number): Place | null {
  for (const [panel, p] of frame.panels.entries()) {
    if (x < p.x || x >= p.x + p.w || y < p.y || y >= p.y + p.h) continue;
    const i = Math.floor(((x - p.x) / p.w) * p.nx);
    const j = p.ny - 1 - Math.floor(((y - p.y) / p.h) * p.ny);
    return { panel, i: Math.min(p.nx - 1, i), j: Math.max(0, j) };
  }
  return null;
}

export function boxOf(frame: Frame, { panel, i, j }: Place) {
  const p = frame.panels[panel]!;
  const [w, h] = [p.w / p.nx, p.h / p.ny];
  return { x: p.x + i * w, y: p.y + p.h - (j + 1) * h, w, h };
}
