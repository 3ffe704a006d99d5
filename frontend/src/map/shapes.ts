/** A picture as a list of shapes, painted on a canvas or written as SVG: both look the same. */

export type Point = readonly [number, number];

interface Style {
  fill?: string;
  stroke?: string;
  width?: number;
  dash?: readonly number[];
  opacity?: number;
}

export type Shape =
  | ({ kind: "rect"; x: number; y: number; w: number; h: number; r?: number } & Style)
  | ({ kind: "lines"; lines: readonly (readonly Point[])[]; close?: boolean } & Style)
  | {
      kind: "text";
      x: number;
      y: number;
      text: string;
      fill: string;
      size: number;
      weight?: number;
      anchor?: "start" | "middle" | "end";
      turned?: boolean;
    };

/** A fill that is hatched instead of plain. */
export const HATCH = "hatch";

export interface Picture {
  width: number;
  height: number;
  shapes: readonly Shape[];
  font: string;
  hatch: { line: string; ground: string };
}

const PITCH = 7;

function hatchPattern(context: CanvasRenderingContext2D, picture: Picture): CanvasPattern | string {
  const tile = document.createElement("canvas");
  const ratio = context.getTransform().a;
  const size = Math.round(PITCH * ratio);
  tile.width = size;
  tile.height = size;
  const inner = tile.getContext("2d")!;
  inner.fillStyle = picture.hatch.ground;
  inner.fillRect(0, 0, size, size);
  inner.strokeStyle = picture.hatch.line;
  inner.lineWidth = 1.2 * ratio;
  inner.beginPath();
  for (const shift of [-size, 0, size]) {
    inner.moveTo(shift - 2, size + 2);
    inner.lineTo(shift + size + 2, -2);
  }
  inner.stroke();
  const pattern = context.createPattern(tile, "repeat");
  pattern?.setTransform(new DOMMatrix().scale(1 / ratio));
  return pattern ?? picture.hatch.ground;
}

export function paint(context: CanvasRenderingContext2D, picture: Picture): void {
  const hatch = hatchPattern(context, picture);
  for (const shape of picture.shapes) {
    if (shape.kind === "text") {
      context.save();
      context.font = `${shape.weight ?? 400} ${shape.size}px ${picture.font}`;
      context.fillStyle = shape.fill;
      context.textAlign =
        shape.anchor === "middle" ? "center" : shape.anchor === "end" ? "right" : "left";
      context.translate(shape.x, shape.y);
      if (shape.turned) context.rotate(-Math.PI / 2);
      context.fillText(shape.text, 0, 0);
      context.restore();
      continue;
    }
    context.beginPath();
    if (shape.kind === "rect") {
      if (shape.r) context.roundRect(shape.x, shape.y, shape.w, shape.h, shape.r);
      else context.rect(shape.x, shape.y, shape.w, shape.h);
    } else {
      for (const line of shape.lines) {
        line.forEach(([x, y], i) => {
          if (i) context.lineTo(x, y);
          else context.moveTo(x, y);
        });
        if (shape.close) context.closePath();
      }
    }
    context.globalAlpha = shape.opacity ?? 1;
    if (shape.fill) {
      context.fillStyle = shape.fill === HATCH ? hatch : shape.fill;
      context.fill();
    }
    if (shape.stroke) {
      context.strokeStyle = shape.stroke;
      context.lineWidth = shape.width ?? 1;
      context.lineJoin = "round";
      context.setLineDash(shape.dash ? [...shape.dash] : []);
      context.stroke();
    }
    context.globalAlpha = 1;
  }
}

const escaped = (text: string) =>
  text.replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]!);
const short = (v: number) => String(Math.round(v * 100) / 100);

function styled(shape: Style): string {
  const parts = [
    `fill="${shape.fill === HATCH ? "url(#hatch)" : (shape.fill ?? "none")}"`,
    shape.stroke && `stroke="${shape.stroke}" stroke-width="${shape.width ?? 1}"`,
    shape.dash?.length && `stroke-dasharray="${shape.dash.join(" ")}"`,
    shape.opacity !== undefined && `opacity="${shape.opacity}"`,
  ];
  return parts.filter(Boolean).join(" ");
}

function element(shape: Shape): string {
  if (shape.kind === "rect") {
    const round = shape.r ? ` rx="${shape.r}"` : "";
    const at = `x="${short(shape.x)}" y="${short(shape.y)}"`;
    return `<rect ${at} width="${short(shape.w)}" height="${short(shape.h)}"${round} ${styled(shape)}/>`;
  }
  if (shape.kind === "lines") {
    const d = shape.lines
      .map((line) => {
        const points = line.map(([x, y]) => `${short(x)} ${short(y)}`);
        return `M${points.join("L")}${shape.close ? "Z" : ""}`;
      })
      .join("");
    return `<path d="${d}" stroke-linejoin="round" ${styled(shape)}/>`;
  }
  const at = `${short(shape.x)} ${short(shape.y)}`;
  const turn = shape.turned ? ` transform="rotate(-90 ${at})"` : "";
  const font = `font-size="${shape.size}" font-weight="${shape.weight ?? 400}"`;
  const [x, y] = at.split(" ");
  const anchor = `text-anchor="${shape.anchor ?? "start"}"`;
  return `<text x="${x}" y="${y}" fill="${shape.fill}" ${font} ${anchor}${turn}>${escaped(shape.text)}</text>`;
}

/** The picture as an SVG file. */
export function toSvg(picture: Picture, title: string): string {
  const { width, height, hatch } = picture;
  const box = `width="${width}" height="${height}" viewBox="0 0 ${width} ${height}"`;
  const pattern =
    `<pattern id="hatch" width="${PITCH}" height="${PITCH}" patternUnits="userSpaceOnUse">` +
    `<rect width="${PITCH}" height="${PITCH}" fill="${hatch.ground}"/>` +
    `<path d="M-1 1L1 -1M0 ${PITCH}L${PITCH} 0M${PITCH - 1} ${PITCH + 1}L${PITCH + 1} ${PITCH - 1}"` +
    ` stroke="${hatch.line}" stroke-width="1.2"/></pattern>`;
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" ${box} font-family="${escaped(picture.font)}" ` +
    `role="img"><title>${escaped(title)}</title><defs>${pattern}</defs>` +
    `${picture.shapes.map(element).join("\n")}</svg>\n`
  );
}
