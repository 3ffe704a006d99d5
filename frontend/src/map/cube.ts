/** All cells of a study as they come, and the flat field of them that a map shows. */

import type { Block, StudyAxis } from "./studies";

/** What is known of a cell. */
export const UNKNOWN = 0;
export const PASSES = 1;
export const STOPPED = 2;

/** Reads one variable; numbers are NaN where there are none. */
export class Cube {
  readonly size: number;
  readonly verdict: Uint8Array;
  readonly strides: readonly number[];
  known = 0;
  private readonly numbers = new Map<string, Float64Array>();
  private readonly words = new Map<string, string[]>();

  constructor(readonly axes: readonly StudyAxis[]) {
    const lengths = axes.map((axis) => axis.values.length);
    this.size = lengths.reduce((all, n) => all * n, 1);
    this.strides = lengths.map((_, k) => lengths.slice(k + 1).reduce((all, n) => all * n, 1));
    this.verdict = new Uint8Array(this.size);
  }

  take(block: Block): void {
    for (const [name, values] of Object.entries(block)) {
      if (name === "cell") continue;
      block.cell.forEach((cell, i) => {
        this.put(name, cell, values[i] ?? null);
      });
    }
    block.cell.forEach((cell, i) => {
      if (this.verdict[cell] === UNKNOWN) this.known += 1;
      this.verdict[cell] = block.state[i] === 1 && block.feasible[i] ? PASSES : STOPPED;
      if (block.state[i] === 2) this.put("reason", cell, "refused");
      if (block.state[i] === 3) this.put("reason", cell, "failed");
    });
  }

  private put(name: string, cell: number, value: number | string | boolean | null): void {
    if (typeof value === "string") {
      const list = this.words.get(name) ?? [];
      this.words.set(name, list);
      list[cell] = value;
    } else if (value !== null) {
      const list = this.numbers.get(name) ?? new Float64Array(this.size).fill(Number.NaN);
      this.numbers.set(name, list);
      list[cell] = Number(value);
    }
  }

  number(name: string, cell: number): number {
    return this.numbers.get(name)?.[cell] ?? Number.NaN;
  }

  word(name: string, cell: number): string {
    return this.words.get(name)?.[cell] ?? "";
  }

  /** Why the robot stops in a cell, as the map's letters have it. */
  reason(cell: number): string {
    const reason = this.word("reason", cell);
    const slips = this.word("quantity", cell) === "friction";
    return reason === "statics" && slips ? "friction" : reason;
  }
}

/** Which axis of a study lies where: x, y, the one that is searched, and those that are fixed. */
export interface Layout {
  x: number;
  y: number | null;
  boundary: number | null;
  others: readonly number[];
}

export function layoutOf(axes: readonly StudyAxis[]): Layout {
  const numeric = (k: number) => typeof axes[k]!.values[0] === "number";
  const all = axes.map((_, k) => k);
  const boundary = all.find((k) => axes[k]!.boundary) ?? null;
  const flat = all.filter((k) => k !== boundary && numeric(k));
  const x = flat[0] ?? 0;
  const y = flat[1] ?? null;
  const others = all.filter((k) => k !== x && k !== y && k !== boundary);
  return { x, y, boundary, others };
}

/** A map's worth of cells, x fastest; row 0 is the lowest y. */
export interface Field {
  nx: number;
  ny: number;
  /** Number in the study of the cell that speaks for each place. */
  cell: Int32Array;
  verdict: Uint8Array;
  /** How many cells wide the coarse one is that is drawn here; 1: its own. */
  coarse: Uint8Array;
  reason: string[];
  /** In the searched axis: the last value that passes. */
  border: Float64Array;
  known: number;
}

/** The field at these indices of the other axes. */
export function fieldOf(cube: Cube, layout: Layout, at: readonly number[]): Field {
  const { axes, strides } = cube;
  const nx = axes[layout.x]!.values.length;
  const ny = layout.y === null ? 1 : axes[layout.y]!.values.length;
  const n = nx * ny;
  const field: Field = {
    nx,
    ny,
    cell: new Int32Array(n).fill(-1),
    verdict: new Uint8Array(n),
    coarse: new Uint8Array(n).fill(1),
    reason: new Array<string>(n).fill(""),
    border: new Float64Array(n).fill(Number.NaN),
    known: 0,
  };
  const base = layout.others.reduce((sum, k, i) => sum + (at[i] ?? 0) * strides[k]!, 0);
  for (let j = 0; j < ny; j++) {
    for (let i = 0; i < nx; i++) {
      const y = layout.y === null ? 0 : j * strides[layout.y]!;
      settle(cube, layout, field, j * nx + i, base + i * strides[layout.x]! + y);
    }
  }
  spread(field);
  return field;
}

function settle(cube: Cube, layout: Layout, field: Field, place: number, cell: number): void {
  if (layout.boundary === null) {
    field.cell[place] = cell;
    field.verdict[place] = cube.verdict[cell]!;
  } else {
    search(cube, layout.boundary, field, place, cell);
  }
  if (field.verdict[place] !== UNKNOWN) field.known += 1;
  if (field.verdict[place] === STOPPED) field.reason[place] = cube.reason(field.cell[place]!);
}

/** The value next to the border that passes; where none does, the one that should have. */
function search(cube: Cube, boundary: number, field: Field, place: number, cell: number): void {
  const axis = cube.axes[boundary]!;
  const count = axis.values.length;
  const fromHigh = axis.name === "friction"; // more of it passes, of all else less does
  const stride = cube.strides[boundary]!;
  let last = -1;
  for (let step = 0; step < count; step++) {
    const k = fromHigh ? count - 1 - step : step;
    const here = cell + k * stride;
    if (cube.verdict[here] === UNKNOWN) continue;
    if (cube.verdict[here] === PASSES) last = k;
    else if (last >= 0 || step === 0) {
      if (last < 0) {
        field.verdict[place] = STOPPED;
        field.cell[place] = here;
      }
      break;
    } else break;
  }
  if (last < 0) return;
  field.verdict[place] = PASSES;
  field.cell[place] = cell + last * stride;
  field.border[place] = axis.values[last] as number;
}

/** Places that are not known yet show the nearest coarse cell. */
function spread({ nx, ny, verdict, coarse, cell, reason, border, known }: Field): void {
  if (known === 0 || known === nx * ny) return;
  const own = verdict.slice();
  const nearest = (index: number, step: number, count: number) =>
    Math.min(count - 1, Math.round(index / step) * step);
  for (let j = 0; j < ny; j++) {
    for (let i = 0; i < nx; i++) {
      const here = j * nx + i;
      if (own[here] !== UNKNOWN) continue;
      for (let step = 2; step < 2 * Math.max(nx, ny); step *= 2) {
        const there = nearest(j, step, ny) * nx + nearest(i, step, nx);
        if (own[there] === UNKNOWN) continue;
        verdict[here] = own[there]!;
        cell[here] = cell[there]!;
        reason[here] = reason[there]!;
        border[here] = border[there]!;
        coarse[here] = Math.min(255, step);
        break;
      }
    }
  }
}
