/** What building codes allow of stairs, as areas of the map of tread against rise [m]. */

import type { Point } from "./shapes";

export interface Code {
  name: string;
  tag: string;
  note: string;
  rise: readonly [number, number];
  tread: readonly [number, number];
  /** Limits of twice the rise plus the tread. */
  pitch?: readonly [number, number];
  dash: readonly number[];
}

export const CODES: readonly Code[] = [
  {
    name: "IBC 2021",
    tag: "IBC",
    note: "1011.5.2: rise 4 to 7 in, tread from 11 in",
    rise: [0.102, 0.178],
    tread: [0.279, Infinity],
    dash: [],
  },
  {
    name: "IRC 2021",
    tag: "IRC",
    note: "R311.7.5: rise to 7¾ in, tread from 10 in",
    rise: [0, 0.197],
    tread: [0.254, Infinity],
    dash: [10, 3],
  },
  {
    name: "OSHA 1910.25",
    tag: "OSHA",
    note: "standard stairs: rise to 9½ in, tread from 9½ in",
    rise: [0, 0.241],
    tread: [0.241, Infinity],
    dash: [10, 3, 2, 3],
  },
  {
    name: "UK Part K",
    tag: "UK K",
    note: "private stairs: rise 150 to 220 mm, going 220 to 300 mm, 2 R + G 550 to 700 mm",
    rise: [0.15, 0.22],
    tread: [0.22, 0.3],
    pitch: [0.55, 0.7],
    dash: [2, 3],
  },
  {
    name: "DIN 18065",
    tag: "DIN",
    note: "buildings: rise 140 to 190 mm, tread 260 to 370 mm, 2 s + a 590 to 650 mm",
    rise: [0.14, 0.19],
    tread: [0.26, 0.37],
    pitch: [0.59, 0.65],
    dash: [6, 3],
  },
];

const EPSILON = 1e-9;

export function allows(code: Code, tread: number, rise: number): boolean {
  const within = (v: number, [low, high]: readonly [number, number]) =>
    v >= low - EPSILON && v <= high + EPSILON;
  if (!within(rise, code.rise) || !within(tread, code.tread)) return false;
  return !code.pitch || within(2 * rise + tread, code.pitch);
}

/** Outline as (tread, rise), cut at the map's edges. Empty where the map shows none of it. */
export function outline(code: Code, tread: Point, rise: Point): Point[] {
  const t = [Math.max(code.tread[0], tread[0]), Math.min(code.tread[1], tread[1])] as const;
  const r = [Math.max(code.rise[0], rise[0]), Math.min(code.rise[1], rise[1])] as const;
  if (t[0] >= t[1] || r[0] >= r[1]) return [];
  let area: Point[] = [
    [t[0], r[0]],
    [t[1], r[0]],
    [t[1], r[1]],
    [t[0], r[1]],
  ];
  if (code.pitch) {
    const [low, high] = code.pitch;
    area = cut(area, ([x, y]) => 2 * y + x - low);
    area = cut(area, ([x, y]) => high - 2 * y - x);
  }
  return area;
}

/** The part of a convex polygon where `side`, which is linear, is not negative. */
function cut(area: readonly Point[], side: (p: Point) => number): Point[] {
  const out: Point[] = [];
  area.forEach((p, i) => {
    const q = area[(i + 1) % area.length]!;
    const [a, b] = [side(p), side(q)];
    if (a >= 0) out.push(p);
    if (a * b < 0) {
      const u = a / (a - b);
      out.push([p[0] + (q[0] - p[0]) * u, p[1] + (q[1] - p[1]) * u]);
    }
  });
  return out;
}
