/** Around the map: values along the axes, their names with units, and the legend. */

import { fixed } from "../geometry/format";
import type { Look } from "./draw";
import { type Frame, type Panel, toX, toY } from "./frame";
import { shade, side } from "./palette";
import type { AxisKind } from "./quantities";
import { HATCH, type Shape } from "./shapes";

const withUnit = (kind: AxisKind) => (kind.unit ? `${kind.title}, ${kind.unit}` : kind.title);

/** As many labels as have room: each `step`-th from the first. */
function labelled(count: number, pixels: number, least: number): number[] {
  const most = Math.max(1, Math.floor(pixels / least));
  const step = [1, 2, 4, 5, 10, 20, 50, 100].find((s) => count / s <= most) ?? count;
  return Array.from({ length: Math.ceil(count / step) }, (_, k) => k * step);
}

export function axisShapes(frame: Frame, look: Look): Shape[] {
  const out: Shape[] = [];
  const { ink } = look;
  const small = { fill: ink.faint, size: 10.5 };
  for (const [index, panel] of frame.panels.entries()) {
    for (const i of labelled(look.x.values.length, panel.w, 40)) {
      const x = toX(panel, i);
      out.push(tick(x, panel.y + panel.h, 0, 4, ink.line), {
        kind: "text",
        ...small,
        x,
        y: panel.y + panel.h + 16,
        text: fixed(look.x.values[i]!, look.x.kind.digits),
        anchor: "middle",
      });
    }
    out.push({
      kind: "text",
      x: panel.x + panel.w / 2,
      y: panel.y + panel.h + 33,
      text: withUnit(look.x.kind),
      fill: ink.soft,
      size: 11,
      weight: 560,
      anchor: "middle",
    });
    if (index === 0) out.push(...upright(panel, look));
  }
  return out;
}

function upright(panel: Panel, look: Look): Shape[] {
  const { ink } = look;
  const out: Shape[] = [];
  for (const j of labelled(look.y.values.length, panel.h, 26)) {
    const y = toY(panel, j);
    out.push(tick(panel.x, y, -4, 0, ink.line), {
      kind: "text",
      fill: ink.faint,
      size: 10.5,
      x: panel.x - 8,
      y: y + 3.5,
      text: fixed(look.y.values[j]!, look.y.kind.digits),
      anchor: "end",
    });
  }
  out.push({
    kind: "text",
    x: 15,
    y: panel.y + panel.h / 2,
    text: withUnit(look.y.kind),
    fill: ink.soft,
    size: 11,
    weight: 560,
    anchor: "middle",
    turned: true,
  });
  return out;
}

const tick = (x: number, y: number, dx: number, dy: number, stroke: string): Shape => ({
  kind: "lines",
  lines: [
    [
      [x, y],
      [x + dx, y + dy],
    ],
  ],
  stroke,
});

const BAR = 240;
/** Below this the legend's name stands over its bar [px]. */
const NARROW = 560;

export function legendShapes(frame: Frame, look: Look, coarse: boolean): Shape[] {
  const { ink, scale, quantity } = look;
  const left = frame.panels[0]!.x;
  const top = frame.legend;
  const w = Math.min(BAR, (frame.width - left - 18) * 0.6);
  const out: Shape[] = [];
  const parts = 60;
  const [low, high] = look.most === null ? [scale.low, scale.high] : [-look.most, look.most];
  const sign = quantity.rising ? -1 : 1;
  for (let k = 0; k < parts; k++) {
    const value = low + ((k + 0.5) / parts) * (high - low);
    const fill =
      look.most === null ? shade(scale.hardness(value)) : side((sign * value) / (look.most || 1));
    out.push({ kind: "rect", x: left + (k * w) / parts, y: top, w: w / parts + 0.4, h: 10, fill });
  }
  const ticks = look.most === null ? scale.ticks : [low, 0, high];
  for (const value of ticks) {
    out.push({
      kind: "text",
      x: left + (w * (value - low)) / (high - low || 1),
      y: top + 22,
      text: fixed(value, quantity.digits),
      fill: ink.faint,
      size: 10.5,
      anchor: "middle",
    });
  }
  const unit = `${quantity.title}, ${quantity.unit}`;
  const name = look.most === null ? unit : `${unit}; darkest: only one passes`;
  const narrow = frame.width < NARROW;
  out.push({
    kind: "text",
    x: narrow ? left : left + w + 14,
    y: narrow ? top - 5 : top + 9,
    text: name,
    fill: ink.soft,
    size: 11,
    weight: 560,
  });
  let x = frame.width - 18;
  const item = (text: string, box: (at: number) => Shape) => {
    x -= text.length * 5.7 + 22;
    if (x < left + w + 30 + (narrow ? 0 : name.length * 6)) return;
    out.push(box(x), { kind: "text", x: x + 21, y: top + 9, text, fill: ink.soft, size: 11 });
    x -= 18;
  };
  const swatch = { y: top, w: 15, h: 10, stroke: ink.line };
  if (look.options.contours && look.most === null) {
    item("contour, smoothed", (at) => ({
      kind: "lines",
      lines: [
        [
          [at, top + 5],
          [at + 15, top + 5],
        ],
      ],
      stroke: ink.soft,
      width: 1.5,
    }));
  }
  item("not possible", (at) => ({ kind: "rect", x: at, ...swatch, fill: HATCH }));
  if (coarse)
    item("large cells: not yet refined", (at) => ({
      kind: "rect",
      x: at,
      ...swatch,
      fill: shade(0.5),
    }));
  return out;
}
