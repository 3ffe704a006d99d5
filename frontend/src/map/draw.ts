/** The picture of a map: cells, what stops the robot, contours; on top codes, axes and legend. */

import { fixed } from "../geometry/format";
import { CODES, outline } from "./codes";
import { contour, smoothed } from "./contours";
import { type Field, STOPPED, UNKNOWN } from "./cube";
import { type Panel, toX, toY } from "./frame";
import { type Ink, inkOn, shade, side } from "./palette";
import { type AxisKind, type Quantity, reasonWords } from "./quantities";
import { borders, regions } from "./regions";
import { type Scale, toIndex } from "./scale";
import { HATCH, type Point, type Shape } from "./shapes";

export interface Content {
  field: Field;
  values: Float64Array;
  /** Over the panel, where there are several. */
  title?: string;
}

export interface Options {
  contours: boolean;
  reasons: boolean;
  numbers: boolean;
  codes: ReadonlySet<string>;
}

export interface Look {
  ink: Ink;
  quantity: Quantity;
  scale: Scale;
  /** Of a difference: the largest there is; else null. */
  most: number | null;
  x: { kind: AxisKind; values: readonly number[] };
  y: { kind: AxisKind; values: readonly number[] };
  options: Options;
}

const colourOf = (look: Look, value: number): string => {
  if (look.most === null) return shade(look.scale.hardness(value));
  const sign = look.quantity.rising ? -1 : 1; // positive: the second is better
  return side((sign * value) / (look.most || 1));
};

const ground = (look: Look, value: number): string =>
  look.most === null ? inkOn(look.scale.hardness(value)) : "#121920";

export function panelShapes(panel: Panel, content: Content, look: Look): Shape[] {
  const { field, values } = content;
  const out: Shape[] = [];
  const cell = (here: number) => {
    const [i, j] = [here % field.nx, Math.floor(here / field.nx)];
    return {
      x: toX(panel, i - 0.5),
      y: toY(panel, j + 0.5),
      w: panel.w / field.nx,
      h: panel.h / field.ny,
    };
  };
  out.push({ kind: "rect", ...bounds(panel), fill: look.ink.ground });
  for (let here = 0; here < values.length; here++) {
    const verdict = field.verdict[here];
    if (verdict === UNKNOWN) continue;
    const box = cell(here);
    const value = values[here]!;
    // A little larger than the cell: no seam shows between neighbours.
    const area = { ...box, w: box.w + 0.4, h: box.h + 0.4 };
    if (verdict === STOPPED) out.push({ kind: "rect", ...area, fill: HATCH });
    else if (Number.isNaN(value)) out.push({ kind: "rect", ...area, fill: look.ink.line });
    else out.push({ kind: "rect", ...area, fill: colourOf(look, value) });
  }
  if (look.options.contours) out.push(...contourShapes(panel, content, look));
  out.push({
    kind: "lines",
    lines: borders(field).map((line) => onPanel(panel, line)),
    stroke: look.ink.soft,
    width: 1.5,
  });
  if (look.options.numbers) out.push(...numberShapes(panel, content, look));
  if (look.options.reasons) out.push(...reasonShapes(panel, field, look));
  out.push(...codeShapes(panel, look));
  if (content.title) {
    out.push({
      kind: "text",
      x: panel.x,
      y: panel.y - 10,
      text: content.title,
      fill: look.ink.text,
      size: 12,
      weight: 600,
    });
  }
  return out;
}

const bounds = ({ x, y, w, h }: Panel) => ({ x, y, w, h });

const onPanel = (panel: Panel, line: readonly Point[]): Point[] =>
  line.map(([i, j]) => [toX(panel, i), toY(panel, j)]);

function contourShapes(panel: Panel, { field, values }: Content, look: Look): Shape[] {
  const { scale, quantity } = look;
  if (look.most !== null || Math.min(field.nx, field.ny) < 4) return []; // too few for a line
  const even = smoothed(values, field.nx, field.ny);
  const out: Shape[] = [];
  const labels: Point[] = [];
  for (const level of scale.ticks.slice(1, -1)) {
    // Just below the tick: a flat part of the field that lies on it makes no line.
    const found = contour(even, field.nx, field.ny, level - 1e-6 * (scale.high - scale.low));
    const lines = found.map((line) => onPanel(panel, line)).filter((line) => length(line) > 24);
    if (lines.length === 0) continue;
    const stroke = ground(look, level);
    out.push({ kind: "lines", lines, stroke, width: 1.1, opacity: 0.75 });
    const longest = lines.reduce((a, b) => (length(b) > length(a) ? b : a));
    if (length(longest) < 90) continue;
    const at = clearest(longest, labels);
    labels.push(at);
    const text = fixed(level, quantity.digits);
    const w = 8 + text.length * 5.6;
    out.push(
      {
        kind: "rect",
        x: at[0] - w / 2,
        y: at[1] - 7,
        w,
        h: 14,
        r: 3,
        fill: colourOf(look, level),
      },
      {
        kind: "text",
        x: at[0],
        y: at[1] + 3.5,
        text,
        fill: stroke,
        size: 10,
        weight: 560,
        anchor: "middle",
      },
    );
  }
  return out;
}

const length = (line: readonly Point[]) =>
  line.reduce((sum, p, k) => {
    const q = line[k - 1];
    return q ? sum + Math.hypot(p[0] - q[0], p[1] - q[1]) : 0;
  }, 0);

/** The point of the middle of a line that is farthest from the labels there are. */
function clearest(line: readonly Point[], labels: readonly Point[]): Point {
  const inner = line.slice(Math.floor(line.length * 0.25), Math.ceil(line.length * 0.75));
  const room = (p: Point) =>
    Math.min(...labels.map((q) => Math.hypot(p[0] - q[0], (p[1] - q[1]) * 2)), 1e4);
  return inner.reduce((best, p) => (room(p) > room(best) + 1 ? p : best), inner[0]!);
}

function numberShapes(panel: Panel, { field, values }: Content, look: Look): Shape[] {
  const [w, h] = [panel.w / field.nx, panel.h / field.ny];
  if (w < 26 || h < 13) return [];
  const out: Shape[] = [];
  for (let here = 0; here < values.length; here++) {
    const value = values[here]!;
    if (!Number.isFinite(value) || field.coarse[here] !== 1) continue;
    out.push({
      kind: "text",
      x: toX(panel, here % field.nx),
      y: toY(panel, Math.floor(here / field.nx)) + 3.5,
      text: fixed(value, look.quantity.digits),
      fill: ground(look, value),
      size: 10,
      anchor: "middle",
    });
  }
  return out;
}

/** One label a region: letter and word where they have room, else the letter. */
function reasonShapes(panel: Panel, field: Field, look: Look): Shape[] {
  const out: Shape[] = [];
  const placed: { x: number; y: number; w: number }[] = [];
  for (const region of regions(field)) {
    const [letter, word] = reasonWords(region.reason);
    const pixels = (region.width * panel.w) / field.nx;
    const area = (region.cells * panel.w * panel.h) / (field.nx * field.ny);
    if (area < 700 || pixels < 14) continue;
    const long = `${letter}  ${word}`;
    const longWidth = long.length * 5.9 + 16;
    const text = pixels > longWidth + 4 ? long : letter;
    const w = text === long ? longWidth : 20;
    const [x, y] = [toX(panel, region.at[0]), toY(panel, region.at[1])];
    const overlaps = placed.some(
      (p) => Math.abs(p.x - x) < (p.w + w) / 2 + 4 && Math.abs(p.y - y) < 24,
    );
    if (overlaps) continue;
    placed.push({ x, y, w });
    const { ink } = look;
    out.push(
      {
        kind: "rect",
        x: x - w / 2,
        y: y - 10,
        w,
        h: 20,
        r: 4,
        fill: ink.panel,
        stroke: ink.line,
      },
      {
        kind: "text",
        x,
        y: y + 4,
        text,
        fill: ink.text,
        size: 11,
        weight: 560,
        anchor: "middle",
      },
    );
  }
  return out;
}

/** Building codes: a dark line with a white casing, told apart by dash, named in a tag. */
function codeShapes(panel: Panel, look: Look): Shape[] {
  const [xs, ys] = [look.x.values, look.y.values];
  const out: Shape[] = [];
  const tags: Shape[] = [];
  const used: Point[] = [];
  for (const code of CODES) {
    if (!look.options.codes.has(code.name)) continue;
    const half = (values: readonly number[]) => (values[1]! - values[0]!) / 2;
    const area = outline(
      code,
      [xs[0]! - half(xs), xs.at(-1)! + half(xs)],
      [ys[0]! - half(ys), ys.at(-1)! + half(ys)],
    );
    if (area.length === 0) continue;
    const line = area.map(([t, r]): Point => {
      const [x, y] = [toX(panel, toIndex(xs, t)), toY(panel, toIndex(ys, r))];
      // Lines on the map's edge stay inside it.
      return [
        Math.min(panel.x + panel.w - 1.5, Math.max(panel.x + 1.5, x)),
        Math.min(panel.y + panel.h - 1.5, Math.max(panel.y + 1.5, y)),
      ];
    });
    out.push(
      { kind: "lines", lines: [line], close: true, stroke: "#fff", width: 4, opacity: 0.75 },
      { kind: "lines", lines: [line], close: true, stroke: "#121920", width: 1.8, dash: code.dash },
    );
    const w = code.tag.length * 6.2 + 10;
    const top = Math.min(...line.map((p) => p[1]));
    const along = line.filter((p) => p[1] < top + 1).map((p) => p[0]);
    const [left, right] = [Math.min(...along), Math.max(...along)];
    const corner = (x: number): Point => [
      Math.max(panel.x + 2, Math.min(x, panel.x + panel.w - w - 2)),
      Math.max(panel.y + 2, top - 8),
    ];
    const free = (p: Point) =>
      used.every((q) => Math.abs(q[0] - p[0]) > 44 || Math.abs(q[1] - p[1]) > 17);
    const bottom = Math.min(panel.y + panel.h - 18, Math.max(...line.map((p) => p[1])) - 8);
    const spots = [
      corner(right - w),
      corner(left),
      corner((left + right - w) / 2),
      [corner(left)[0], bottom] as const,
      [corner(right - w)[0], bottom] as const,
    ];
    const [x, y] = spots.find(free) ?? spots[0]!;
    used.push([x, y]);
    tags.push(
      { kind: "rect", x, y, w, h: 16, r: 3, fill: "#fff", stroke: "#121920", width: 0.5 },
      {
        kind: "text",
        x: x + w / 2,
        y: y + 11.5,
        text: code.tag,
        fill: "#121920",
        size: 10,
        weight: 600,
        anchor: "middle",
      },
    );
  }
  return [...out, ...tags];
}
