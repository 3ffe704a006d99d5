/** A plot as a file: its numbers as CSV, its picture as SVG or PNG. */

import { fixed } from "../geometry/format";
import { plan } from "../state/planning";
import { runPlan } from "../state/rollouts";
import { saveFile } from "../ui/save-file";
import { limitText } from "./limits";
import type { Line, Panel } from "./lines";
import { palette } from "./palette";
import { timeWindow } from "./window";

/** Size of the saved picture, and room for its axes [px]. */
const WIDTH = 960;
const HEIGHT = 480;
const EDGE = { left: 64, right: 20, top: 44, bottom: 44 };
const PNG_SCALE = 2;
const FONT = "12px Inter, system-ui, sans-serif";

const escaped = (text: string) =>
  text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll('"', "&quot;");

/** One row a sample: the time, then each line in the panel's unit. */
export function asCsv(panel: Panel): string {
  const lines = panel.halves.flat();
  const unitOf = (line: Line) => (line.raw ? (line.read?.unit ?? panel.unit) : panel.unit);
  const limits = panel.limits ?? [];
  const head = [
    "time_s",
    ...lines.map((line) => `${line.label} [${unitOf(line) || "1"}]`),
    ...limits.map((limit) => `${limit.of} limit [${panel.unit}]`),
  ];
  const rows = [...panel.time].map((t, i) =>
    [t, ...lines.map((line) => (line.raw ?? line.values)[i]!), ...limits.map((l) => l.value)]
      .map((v) => (Number.isNaN(v) ? "" : String(Number(v.toPrecision(9)))))
      .join(","),
  );
  return `${[head.map((h) => (h.includes(",") ? `"${h}"` : h)).join(","), ...rows].join("\n")}\n`;
}

/** Steps of an axis that people count in. */
function steps(low: number, high: number, count: number): number[] {
  const wish = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(wish));
  const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= wish) ?? wish;
  const out: number[] = [];
  for (let k = Math.ceil(low / step); k * step <= high; k++) out.push(k * step);
  return out;
}

/** Lines of one half between `top` and `bottom`, with grid and numbers. */
function half(panel: Panel, lines: readonly Line[], top: number, bottom: number): string {
  const colors = palette();
  const [from, to] = timeWindow.peek();
  const seen = lines.flatMap((line) => [...line.values].filter((v) => Number.isFinite(v)));
  const limits = panel.limits ?? [];
  seen.push(...limits.map((limit) => limit.value));
  if (seen.length === 0) return "";
  const [least, most] = [
    seen.reduce((a, b) => Math.min(a, b)),
    seen.reduce((a, b) => Math.max(a, b)),
  ];
  const pad = Math.max(most - least, 1e-6) * 0.06;
  const [low, high] = [least - pad, most + pad];
  const right = WIDTH - EDGE.right;
  const px = (t: number) => EDGE.left + ((t - from) / (to - from)) * (right - EDGE.left);
  const py = (v: number) => bottom - ((v - low) / (high - low)) * (bottom - top);
  const grid = steps(low, high, 5).map(
    (v) =>
      `<path d="M${EDGE.left} ${py(v).toFixed(1)}H${right}" stroke="${colors.line}"/>` +
      `<text x="${EDGE.left - 8}" y="${(py(v) + 4).toFixed(1)}" text-anchor="end">${fixed(v, high - low < 5 ? 1 : 0)}</text>`,
  );
  const drawn = lines.map((line) => {
    let d = "";
    let down = false;
    panel.time.forEach((t, i) => {
      const v = line.values[i]!;
      const inside = t >= from && t <= to && Number.isFinite(v);
      if (inside) d += `${down ? "L" : "M"}${px(t).toFixed(1)} ${py(v).toFixed(1)}`;
      down = inside;
    });
    const band = line.kind === "band";
    const dash = line.kind === "dash" ? ' stroke-dasharray="6 3"' : "";
    return `<path d="${d}" fill="none" stroke="${colors[line.color]}" stroke-width="${band ? 6 : 1.6}" stroke-opacity="${band ? 0.34 : 1}" stroke-linejoin="round"${dash}/>`;
  });
  const bounds = limits.map((limit, k) => {
    const y = py(limit.value);
    // Names of limits close to each other stand side by side.
    const x = right - 4 - (k % 2) * (right - EDGE.left) * 0.25;
    return (
      `<path d="M${EDGE.left} ${y.toFixed(1)}H${right}" stroke="${colors.bad}" stroke-dasharray="2 3"/>` +
      `<text x="${x}" y="${(y - 4).toFixed(1)}" text-anchor="end" fill="${colors.bad}">${escaped(limitText(limit))}</text>`
    );
  });
  return [...grid, ...drawn, ...bounds].join("");
}

/** The panel as a picture of its own, in the page's colours. */
export function asSvg(panel: Panel): string {
  const colors = palette();
  const css = getComputedStyle(document.documentElement);
  const [from, to] = timeWindow.peek();
  const count = panel.halves.length;
  const tall = (HEIGHT - EDGE.top - EDGE.bottom) / count;
  const halves = panel.halves.map((lines, k) =>
    half(panel, lines, EDGE.top + k * tall + (k ? 12 : 0), EDGE.top + (k + 1) * tall),
  );
  const right = WIDTH - EDGE.right;
  const times = steps(from, to, 8).map((t) => {
    const x = EDGE.left + ((t - from) / (to - from)) * (right - EDGE.left);
    return `<text x="${x.toFixed(1)}" y="${HEIGHT - 22}" text-anchor="middle">${fixed(t, to - from < 8 ? 1 : 0)}</text>`;
  });
  let x = EDGE.left;
  const legend = panel.halves.flat().map((line) => {
    const at = x;
    x += 34 + line.label.length * 7;
    return `<path d="M${at} 31h16" stroke="${colors[line.color]}" stroke-width="${line.kind === "band" ? 6 : 2}" stroke-opacity="${line.kind === "band" ? 0.34 : 1}"/><text x="${at + 22}" y="35">${escaped(line.label)}</text>`;
  });
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" width="${WIDTH}" height="${HEIGHT}" viewBox="0 0 ${WIDTH} ${HEIGHT}">` +
    `<rect width="${WIDTH}" height="${HEIGHT}" fill="${css.getPropertyValue("--bg1").trim()}"/>` +
    `<g font-family="Inter, system-ui, sans-serif" font-size="12" fill="${colors.tx2}">` +
    `<text x="${EDGE.left}" y="18" font-weight="600" fill="${colors.tx}">${escaped(`${panel.title}, ${panel.unit}`)}</text>` +
    `${legend.join("")}${halves.join("")}${times.join("")}` +
    `<text x="${right}" y="${HEIGHT - 6}" text-anchor="end">time, s</text></g></svg>\n`
  );
}

async function asPng(panel: Panel): Promise<Blob> {
  await document.fonts.load(FONT);
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(asSvg(panel))}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = WIDTH * PNG_SCALE;
  canvas.height = HEIGHT * PNG_SCALE;
  canvas.getContext("2d")!.drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((resolve, reject) =>
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("no picture"))), "image/png"),
  );
}

export type PlotFormat = "png" | "svg" | "csv";

export async function savePlot(panel: Panel, format: PlotFormat): Promise<void> {
  const of = runPlan.peek() ?? plan.peek();
  const name = `${of?.terrain.name ?? "plan"}-${of?.robot ?? "robot"}-${panel.id}.${format}`;
  if (format === "csv") saveFile(name, asCsv(panel), "text/csv");
  else if (format === "svg") saveFile(name, asSvg(panel), "image/svg+xml");
  else saveFile(name, await asPng(panel));
}
