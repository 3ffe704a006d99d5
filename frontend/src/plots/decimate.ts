/** As many points as there are pixels, and never a peak lost. */

import { lowerIndex } from "../geometry/frames";

export type Column = ArrayLike<number>;

/**
 * The part of the columns between x `from` and `to`, with the least and the greatest value of each
 * column in each of `buckets` stretches, in the order in which they occur.
 */
export function decimate(
  columns: readonly Column[],
  from: number,
  to: number,
  buckets: number,
): number[][] {
  const x = columns[0]!;
  const first = Math.max(0, lowerIndex(x, from));
  const last = Math.min(x.length - 1, lowerIndex(x, to) + 1);
  const count = last - first + 1;
  if (count <= 2 * buckets) {
    return columns.map((column) => Array.prototype.slice.call(column, first, last + 1) as number[]);
  }
  const out: number[][] = columns.map(() => []);
  for (let b = 0; b < buckets; b++) {
    const lo = first + Math.floor((b * count) / buckets);
    const hi = first + Math.floor(((b + 1) * count) / buckets) - 1;
    out[0]!.push(x[lo]!, x[hi]!);
    for (let k = 1; k < columns.length; k++) out[k]!.push(...extremes(columns[k]!, lo, hi));
  }
  return out;
}

function extremes(column: Column, lo: number, hi: number): [number, number] {
  let least = lo;
  let most = lo;
  for (let i = lo; i <= hi; i++) {
    const v = column[i]!;
    if (v < column[least]! || Number.isNaN(column[least]!)) least = i;
    if (v > column[most]! || Number.isNaN(column[most]!)) most = i;
  }
  return least < most ? [column[least]!, column[most]!] : [column[most]!, column[least]!];
}
