/** How much of a building code's stairs a robot climbs, over the cells of the map. */

import { allows, type Code } from "./codes";
import { PASSES, UNKNOWN } from "./cube";
import { LEAST } from "./quantities";
import { fields, ready } from "./state";

export interface Climbed {
  asked: number;
  percent: number;
  /** The most of the least frictions, and the least CoM margin [m], of stairs it climbs. */
  friction: number;
  com: number;
}

export function share(
  code: Code,
  robot: number,
  treads: readonly number[],
  rises: readonly number[],
): Climbed {
  const [cube, field] = [ready(), fields.value[robot]];
  const out: Climbed = { asked: 0, percent: Number.NaN, friction: Number.NaN, com: Number.NaN };
  if (!cube || !field) return out;
  let climbed = 0;
  rises.forEach((rise, j) => {
    treads.forEach((tread, i) => {
      const here = j * treads.length + i;
      const verdict = field.verdict[here];
      if (verdict === UNKNOWN || !allows(code, tread, rise)) return;
      out.asked += 1;
      if (verdict !== PASSES) return;
      climbed += 1;
      const cell = field.cell[here]!;
      const border = field.border[here]!;
      const friction = Number.isNaN(border) ? cube.number(LEAST, cell) : border;
      out.friction = worse(out.friction, friction, Math.max);
      out.com = worse(out.com, cube.number("margin_com", cell), Math.min);
    });
  });
  out.percent = (100 * climbed) / out.asked;
  return out;
}

const worse = (a: number, b: number, pick: (a: number, b: number) => number) =>
  Number.isNaN(a) ? b : Number.isNaN(b) ? a : pick(a, b);
