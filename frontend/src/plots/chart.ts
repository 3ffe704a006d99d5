/** One uPlot for one panel: two plots above each other, bands below lines, quiet axes. */

import uPlot from "uplot";
import { fixed } from "../geometry/format";
import { decimate } from "./decimate";
import { type LimitLine, limitText } from "./limits";
import type { Line, Panel } from "./lines";
import type { Palette } from "./palette";

export const LEFT = 34;
export const RIGHT = 8;
const TOP = 6;
const BOTTOM = 20;
const FONT = "10px InterVariable, Inter, system-ui, sans-serif";
/** Share of the height that each of two halves takes. */
const HALF = 0.46;

/** A stretch of time with a tint: what has run, where it fell, what is not planned. */
export interface Tint {
  from: number;
  to: number;
  kind: "done" | "failed" | "unplanned";
}

export interface ChartState {
  panel: Panel;
  window: [number, number];
  tint: Tint | null;
}

function extremes(lines: readonly Line[]): [number, number] {
  let lo = Number.POSITIVE_INFINITY;
  let hi = Number.NEGATIVE_INFINITY;
  for (const line of lines) {
    for (const v of line.values) {
      if (v < lo) lo = v;
      if (v > hi) hi = v;
    }
  }
  return [lo, hi];
}

/** Value range of a half in its data. */
function dataRange(lines: readonly Line[], least: number): [number, number] {
  const bands = extremes(lines.filter((line) => line.kind === "band"));
  let [lo, hi] = extremes(lines);
  if (bands[0] <= bands[1]) {
    // A fall may leave the plot: what was asked for stays legible.
    const room = 0.6 * Math.max(bands[1] - bands[0], least);
    lo = Math.max(lo, bands[0] - room);
    hi = Math.min(hi, bands[1] + room);
  }
  if (lo > hi) return [-least / 2, least / 2];
  const grow = Math.max(0, least - (hi - lo)) / 2;
  const pad = Math.max(hi - lo, least) * 0.08;
  return [lo - grow - pad, hi + grow + pad];
}

function ticks(lo: number, hi: number, most: number): number[] {
  const rough = (hi - lo) / most;
  const size = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * size).find((s) => s >= rough)!;
  const out: number[] = [];
  for (let i = Math.ceil(lo / step); i * step <= hi + 1e-9; i++)
    out.push(Number((i * step).toPrecision(6)));
  return out;
}

export class Chart {
  private readonly plot: uPlot;
  private ranges: [number, number][] = [];

  constructor(
    holder: HTMLElement,
    width: number,
    height: number,
    private state: ChartState,
    private readonly colors: Palette,
  ) {
    this.measure();
    this.plot = new uPlot(this.options(width, height), this.data(width), holder);
  }

  destroy(): void {
    this.plot.destroy();
  }

  resize(width: number, height: number): void {
    this.plot.setSize({ width, height });
    this.plot.setData(this.data(width));
  }

  update(state: ChartState): void {
    this.state = state;
    this.measure();
    this.plot.setData(this.data(this.plot.width));
  }

  private measure(): void {
    const { panel } = this.state;
    this.ranges = panel.halves.map((lines, i) =>
      panel.range && i === 0 ? panel.range : dataRange(lines, panel.spans[i]!),
    );
  }

  private data(width: number): uPlot.AlignedData {
    const { panel, window } = this.state;
    const columns = [panel.time, ...panel.halves.flat().map((line) => line.values)];
    if (panel.time.length === 0)
      return columns.map(() => [window[0]]) as unknown as uPlot.AlignedData;
    const points = Math.max(50, Math.round(width - LEFT - RIGHT));
    const cut = decimate(columns, window[0], window[1], points);
    // uPlot leaves a gap where a value is null, not where it is NaN.
    return cut.map((c, i) =>
      i === 0 ? c : c.map((v) => (Number.isNaN(v) ? null : v)),
    ) as uPlot.AlignedData;
  }

  /** The scale of half `i`: its data keep to their part of the height. */
  private scale(i: number): [number, number] {
    const [lo, hi] = this.ranges[i] ?? [0, 1];
    if (this.state.panel.halves.length === 1) return [lo, hi];
    const whole = (hi - lo) / HALF;
    return i === 0 ? [hi - whole, hi] : [lo, lo + whole];
  }

  private options(width: number, height: number): uPlot.Options {
    const { panel } = this.state;
    const c = this.colors;
    const two = panel.halves.length === 2;
    const axis = (i: number): uPlot.Axis => ({
      scale: `y${i}`,
      side: 3,
      // Both halves label the same edge: the first takes no room of its own.
      size: two && i === 0 ? 0 : LEFT,
      gap: 6,
      font: FONT,
      stroke: c.tx3,
      ticks: { show: false },
      grid: { stroke: c.line, width: 1 },
      splits: () => ticks(...(this.ranges[i] ?? [0, 1]), two ? 2.6 : 3.9),
      values: (_, splits) =>
        splits.map((v) => fixed(v, Number.isInteger(v) ? 0 : 1) + (panel.unit === "%" ? "%" : "")),
    });
    return {
      width,
      height,
      padding: [TOP, RIGHT, 0, 0],
      legend: { show: false },
      cursor: { show: false },
      scales: {
        x: { time: false, range: () => this.state.window },
        ...Object.fromEntries(
          panel.halves.map((_, i) => [`y${i}`, { range: () => this.scale(i) }]),
        ),
      },
      axes: [
        {
          size: BOTTOM,
          gap: 5,
          font: FONT,
          stroke: c.tx3,
          ticks: { show: false },
          grid: { show: false },
          splits: (_u, _i, lo, hi) => ticks(lo, hi, 3.8).filter((t) => t <= hi - (hi - lo) * 0.06),
          values: (_, splits) => splits.map((v) => fixed(v, Number.isInteger(v) ? 0 : 2)),
        },
        ...panel.halves.map((_, i) => axis(i)),
      ],
      series: [
        {},
        ...panel.halves.flatMap((lines, i) => lines.map((line) => this.series(line, i))),
      ],
      hooks: {
        drawClear: [(u) => this.background(u)],
        draw: [(u) => this.foreground(u)],
      },
    };
  }

  private series(line: Line, half: number): uPlot.Series {
    const band = line.kind === "band";
    return {
      scale: `y${half}`,
      stroke: this.colors[line.color],
      width: band ? 5 : line.kind === "dash" ? 1.5 : 1.4,
      alpha: band ? 0.34 : 1,
      cap: "round",
      ...(line.kind === "dash" ? { dash: [6, 3] } : {}),
      points: { show: false },
    };
  }

  private background(u: uPlot): void {
    const { tint } = this.state;
    if (!tint) return;
    const fill = {
      done: this.colors.acSoft,
      failed: this.colors.badSoft,
      unplanned: this.colors.s0,
    }[tint.kind];
    const x0 = Math.max(u.bbox.left, u.valToPos(tint.from, "x", true));
    const x1 = Math.min(u.bbox.left + u.bbox.width, u.valToPos(tint.to, "x", true));
    u.ctx.save();
    u.ctx.globalAlpha = 0.65;
    u.ctx.fillStyle = fill;
    u.ctx.fillRect(x0, u.bbox.top, Math.max(0, x1 - x0), u.bbox.height);
    u.ctx.restore();
  }

  private foreground(u: uPlot): void {
    const { panel } = this.state;
    const { ctx, bbox } = u;
    const ratio = devicePixelRatio;
    ctx.save();
    ctx.font = FONT.replace("10px", `${10 * ratio}px`);
    ctx.fillStyle = this.colors.tx3;
    ctx.textBaseline = "alphabetic";
    ctx.textAlign = "right";
    ctx.fillText("s", bbox.left + bbox.width, bbox.top + bbox.height + 15 * ratio);
    if (panel.caption && panel.halves.length === 2 && panel.halves[1]!.length > 0) {
      ctx.textAlign = "left";
      ctx.fillStyle = this.colors.tx2;
      ctx.fillText(
        panel.caption,
        bbox.left + 4 * ratio,
        bbox.top + bbox.height * (1 - HALF) + 6 * ratio,
      );
    }
    this.limits(u, panel.limits ?? [], ratio);
    if (panel.cross) this.cross(u, panel.cross, ratio);
    ctx.restore();
  }

  private limits(u: uPlot, limits: readonly LimitLine[], ratio: number): void {
    const { ctx, bbox } = u;
    ctx.fillStyle = this.colors.bad;
    ctx.lineJoin = "round";
    ctx.textAlign = "right";
    let [above, right] = [Number.NEGATIVE_INFINITY, 0];
    for (const limit of limits) {
      const y = Math.round(u.valToPos(limit.value, "y0", true)) + 0.5;
      ctx.strokeStyle = this.colors.bad;
      ctx.lineWidth = ratio;
      ctx.setLineDash([2 * ratio, 3 * ratio]);
      ctx.beginPath();
      ctx.moveTo(bbox.left, y);
      ctx.lineTo(bbox.left + bbox.width, y);
      ctx.stroke();
      ctx.setLineDash([]);
      // Limits close to each other have their names side by side, low ones above their line.
      if (y - above > 13 * ratio) right = bbox.left + bbox.width - 2 * ratio;
      const text = limitText(limit);
      const low = y + 16 * ratio > bbox.top + bbox.height;
      const base = low ? y - 4 * ratio : y + 13 * ratio;
      // Legible over the lines of the plot.
      ctx.strokeStyle = this.colors.bg;
      ctx.lineWidth = 3 * ratio;
      ctx.strokeText(text, right, base);
      ctx.fillText(text, right, base);
      right -= ctx.measureText(text).width + 8 * ratio;
      above = y;
    }
  }

  /** Where B fell: a cross at the end of its line. */
  private cross(u: uPlot, at: { time: number; value: number }, ratio: number): void {
    const { ctx } = u;
    const [lo, hi] = this.ranges[0]!;
    const x = u.valToPos(at.time, "x", true);
    const y = u.valToPos(Math.min(hi, Math.max(lo, at.value)), "y0", true);
    const r = 4 * ratio;
    ctx.strokeStyle = this.colors.tx2;
    ctx.lineWidth = 1.5 * ratio;
    ctx.beginPath();
    ctx.moveTo(x - r, y - r);
    ctx.lineTo(x + r, y + r);
    ctx.moveTo(x + r, y - r);
    ctx.lineTo(x - r, y + r);
    ctx.stroke();
  }
}
