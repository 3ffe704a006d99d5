/** Lines of equal value through a field: marching squares over the cells' centres, then rounded. */

import type { Point } from "./shapes";

/** Mean of each value and its neighbours, 1-2-1 each way; NaN stays NaN. */
export function smoothed(values: Float64Array, nx: number, ny: number): Float64Array {
  const out = new Float64Array(values.length).fill(Number.NaN);
  for (let j = 0; j < ny; j++) {
    for (let i = 0; i < nx; i++) {
      if (Number.isNaN(values[j * nx + i])) continue;
      let sum = 0;
      let weight = 0;
      for (let dj = -1; dj <= 1; dj++) {
        for (let di = -1; di <= 1; di++) {
          const [a, b] = [i + di, j + dj];
          if (a < 0 || b < 0 || a >= nx || b >= ny) continue;
          const v = values[b * nx + a]!;
          if (Number.isNaN(v)) continue;
          const w = (2 - Math.abs(di)) * (2 - Math.abs(dj));
          sum += w * v;
          weight += w;
        }
      }
      out[j * nx + i] = sum / weight;
    }
  }
  return out;
}

/** Lines at `level`, in cells: (0, 0) is the centre of the first. */
export function contour(values: Float64Array, nx: number, ny: number, level: number): Point[][] {
  const segments: [string, Point, string, Point][] = [];
  for (let j = 0; j + 1 < ny; j++) {
    for (let i = 0; i + 1 < nx; i++) segments.push(...crossing(values, nx, i, j, level));
  }
  return joined(segments).map(rounded);
}

function crossing(
  values: Float64Array,
  nx: number,
  i: number,
  j: number,
  level: number,
): [string, Point, string, Point][] {
  const corner: Point[] = [
    [i, j],
    [i + 1, j],
    [i + 1, j + 1],
    [i, j + 1],
  ];
  const v = corner.map(([a, b]) => values[b * nx + a]! - level);
  if (v.some(Number.isNaN)) return [];
  const cuts: [string, Point][] = [];
  for (let k = 0; k < 4; k++) {
    const [p, q] = [corner[k]!, corner[(k + 1) % 4]!];
    const [a, b] = [v[k]!, v[(k + 1) % 4]!];
    if (a < 0 === b < 0) continue;
    const u = a / (a - b);
    const key = [p, q].map((c) => c.join()).sort();
    cuts.push([key.join(";"), [p[0] + (q[0] - p[0]) * u, p[1] + (q[1] - p[1]) * u]]);
  }
  const pairs: [string, Point, string, Point][] = [];
  for (let k = 0; k + 1 < cuts.length; k += 2) pairs.push([...cuts[k]!, ...cuts[k + 1]!]);
  return pairs;
}

/** Segments that share an edge of the grid become one line. */
function joined(segments: readonly [string, Point, string, Point][]): Point[][] {
  const at = new Map<string, number[]>();
  segments.forEach(([a, , b], k) => {
    for (const key of [a, b]) at.set(key, [...(at.get(key) ?? []), k]);
  });
  const used = new Set<number>();
  const follow = (start: number, key: string): Point[] => {
    const line: Point[] = [];
    let [now, end] = [start, key];
    for (;;) {
      const next = at.get(end)?.find((k) => k !== now && !used.has(k));
      if (next === undefined) return line;
      used.add(next);
      const [a, p, b, q] = segments[next]!;
      line.push(a === end ? q : p);
      [now, end] = [next, a === end ? b : a];
    }
  };
  const lines: Point[][] = [];
  segments.forEach(([a, p, b, q], k) => {
    if (used.has(k)) return;
    used.add(k);
    const ahead = follow(k, b);
    lines.push([...follow(k, a).reverse(), p, q, ...ahead]);
  });
  return lines;
}

/** Corners cut twice (Chaikin); the ends stay. */
function rounded(line: readonly Point[]): Point[] {
  let out = [...line];
  for (let pass = 0; pass < 2 && out.length > 2; pass++) {
    const next: Point[] = [out[0]!];
    for (let k = 0; k + 1 < out.length; k++) {
      const [p, q] = [out[k]!, out[k + 1]!];
      if (k > 0) next.push([0.75 * p[0] + 0.25 * q[0], 0.75 * p[1] + 0.25 * q[1]]);
      if (k + 2 < out.length) next.push([0.25 * p[0] + 0.75 * q[0], 0.25 * p[1] + 0.75 * q[1]]);
    }
    next.push(out[out.length - 1]!);
    out = next;
  }
  return out;
}
