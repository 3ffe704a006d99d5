/** The drawn polyline: heights, faces and the words for its corners. */

import type { Vec2 } from "../api/types";

export type Points = readonly Vec2[];

/** Shorter than this along x, a segment is a vertical face. */
const UPRIGHT = 1e-6;
/** Steeper than this (70 degrees), people call it a riser. */
const STEEP = 2.75;
const LEVEL = 1e-6;

export type SegmentKind = "flat" | "upright" | "slope";

export function segmentKind(a: Vec2, b: Vec2): SegmentKind {
  const run = Math.abs(b[0] - a[0]);
  // Two corners on one spot are no face.
  if (run < UPRIGHT && Math.abs(b[1] - a[1]) < LEVEL) return "flat";
  if (run < UPRIGHT || Math.abs(b[1] - a[1]) > STEEP * run) return "upright";
  return Math.abs(b[1] - a[1]) < LEVEL ? "flat" : "slope";
}

/** Upper ground height at x; constant beyond the ends. */
export function heightAt(points: Points, x: number): number {
  const first = points[0];
  const last = points[points.length - 1];
  if (!first || !last) return 0;
  if (x < first[0]) return first[1];
  if (x > last[0]) return last[1];
  let top = Number.NEGATIVE_INFINITY;
  for (let i = 0; i + 1 < points.length; i++) {
    const a = points[i]!;
    const b = points[i + 1]!;
    if (x < a[0] || x > b[0]) continue;
    const run = b[0] - a[0];
    const z = run < UPRIGHT ? Math.max(a[1], b[1]) : a[1] + ((b[1] - a[1]) * (x - a[0])) / run;
    top = Math.max(top, z);
  }
  return top;
}

const ORDINALS = new Intl.PluralRules("en", { type: "ordinal" });
const SUFFIX: Record<string, string> = { one: "st", two: "nd", few: "rd", other: "th" };

export function ordinal(n: number): string {
  return `${n}${SUFFIX[ORDINALS.select(n)]}`;
}

/** What a person would call each corner: "3rd nosing", "foot of the 1st riser", "ramp top". */
export function cornerNames(points: Points): string[] {
  const names: string[] = [];
  let risers = 0;
  let drops = 0;
  for (let i = 0; i < points.length; i++) {
    const before = i > 0 ? segmentKind(points[i - 1]!, points[i]!) : null;
    const after = i + 1 < points.length ? segmentKind(points[i]!, points[i + 1]!) : null;
    const rises = after === "upright" && points[i + 1]![1] > points[i]![1];
    if (before === null) names.push("start of the profile");
    else if (after === null) names.push("end of the profile");
    else if (after === "upright") {
      if (rises) names.push(`foot of the ${ordinal(++risers)} riser`);
      else names.push(`edge of the ${ordinal(++drops)} drop`);
    } else if (before === "upright") {
      const up = points[i]![1] > points[i - 1]![1];
      names.push(up ? `${ordinal(risers)} nosing` : `foot of the ${ordinal(drops)} drop`);
    } else if (after === "slope") names.push(before === "slope" ? "bend" : "ramp start");
    else if (before === "slope") names.push("ramp end");
    else names.push("corner");
  }
  return names;
}

/** The corner nearest to a place, for sentences such as "at x 0.60 m, 3rd nosing". */
export function nearestCorner(points: Points, at: Vec2, within = 0.08): string | null {
  let best: number | null = null;
  let least = within;
  points.forEach((p, i) => {
    const d = Math.hypot(p[0] - at[0], p[1] - at[1]);
    if (d < least) {
      least = d;
      best = i;
    }
  });
  return best === null ? null : cornerNames(points)[best]!;
}

export function extent(points: Points): { x: Vec2; z: Vec2 } {
  const xs = points.map((p) => p[0]);
  const zs = points.map((p) => p[1]);
  return {
    x: [Math.min(...xs), Math.max(...xs)],
    z: [Math.min(...zs), Math.max(...zs)],
  };
}

export function samePoints(a: Points, b: Points): boolean {
  return a.length === b.length && a.every((p, i) => p[0] === b[i]![0] && p[1] === b[i]![1]);
}
