/** From a field to what is coloured: values of a quantity, their range in round numbers. */

import { type Cube, type Field, PASSES } from "./cube";
import { LEAST, type Quantity } from "./quantities";

/** Values as they are shown; NaN where the robot does not pass or there is no number. */
export function valuesOf(cube: Cube, field: Field, quantity: Quantity): Float64Array {
  const searched = quantity.name === LEAST && cube.axes.some((a) => a.boundary && isFriction(a));
  return field.border.map((border, here) => {
    if (field.verdict[here] !== PASSES) return Number.NaN;
    return searched ? border : cube.number(quantity.name, field.cell[here]!) * quantity.scale;
  });
}

const isFriction = (axis: { name: string }) => axis.name === "friction";

export interface Scale {
  low: number;
  high: number;
  ticks: readonly number[];
  step: number;
  /** 0: easy, 1: hard. */
  hardness: (value: number) => number;
}

const STEPS = [1, 2, 2.5, 5];

/** A round step that divides `span` into at most `most` parts. */
export function roundStep(span: number, most: number): number {
  const raw = span / most;
  const power = 10 ** Math.floor(Math.log10(raw));
  const factor = STEPS.find((each) => each * power >= raw * (1 - 1e-9)) ?? 10;
  return factor * power;
}

/** One scale for all these values. */
export function scaleOf(all: readonly Float64Array[], quantity: Quantity): Scale {
  let [low, high] = [Infinity, -Infinity];
  for (const values of all) {
    for (const v of values) {
      if (!Number.isFinite(v)) continue;
      low = Math.min(low, v);
      high = Math.max(high, v);
    }
  }
  if (low > high) [low, high] = [0, 1];
  const least = 10 ** -quantity.digits * 10; // narrower than this, colours would show noise
  if (high - low < least) [low, high] = [low - least / 2, high + least / 2];
  const step = roundStep(high - low, 6);
  low = Math.floor(low / step + 1e-9) * step;
  high = Math.ceil(high / step - 1e-9) * step;
  const count = Math.round((high - low) / step);
  const ticks = Array.from({ length: count + 1 }, (_, k) => low + k * step);
  const hardness = (v: number) =>
    quantity.rising ? (v - low) / (high - low) : (high - v) / (high - low);
  return { low, high, ticks, step, hardness };
}

/**
 * The second minus the first, and the largest of its sizes. Where only one of them has a value it
 * is infinite, towards the one that passes.
 */
export function difference(
  a: Float64Array,
  b: Float64Array,
  rising: boolean,
): { values: Float64Array; most: number } {
  const sign = rising ? -1 : 1;
  const values = a.map((v, k) => {
    const w = b[k]!;
    if (Number.isNaN(v) === Number.isNaN(w)) return w - v;
    return sign * (Number.isNaN(v) ? Infinity : -Infinity);
  });
  const most = values.reduce((m, v) => (Number.isFinite(v) ? Math.max(m, Math.abs(v)) : m), 0);
  return { values, most };
}

/** Place of a value among the cells of an axis, in cells; between them in proportion. */
export function toIndex(values: readonly number[], value: number): number {
  const n = values.length;
  if (n < 2) return 0;
  const rising = values[1]! > values[0]!;
  let k = 0;
  while (k < n - 2 && (rising ? values[k + 1]! < value : values[k + 1]! > value)) k += 1;
  return k + (value - values[k]!) / (values[k + 1]! - values[k]!);
}
