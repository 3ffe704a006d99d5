/** The mesh seen from above, stronger where it is higher, and the plane that cuts it: to drag, to turn. */

import { useEffect, useRef, useState } from "preact/hooks";
import type { MeshHeights, Vec2 } from "../api/types";
import { degrees, fixed } from "../geometry/format";
import { cut, cutProblem, extent, heights, move, moveThrough, pointAt } from "./cut";

const WIDTH = 400;
const HEIGHT = 240;
const PAD = 28;

/** Metres to pixels of the drawing and back: one scale for both axes, y up. */
function placing([[x0, x1], [y0, y1]]: [Vec2, Vec2]) {
  const scale = Math.min(
    (WIDTH - 2 * PAD) / Math.max(x1 - x0, 1e-6),
    (HEIGHT - 2 * PAD) / Math.max(y1 - y0, 1e-6),
  );
  const left = (WIDTH - scale * (x1 - x0)) / 2;
  const top = (HEIGHT - scale * (y1 - y0)) / 2;
  return {
    scale,
    at: ([x, y]: Vec2): Vec2 => [left + scale * (x - x0), top + scale * (y1 - y)],
    back: ([px, py]: Vec2): Vec2 => [x0 + (px - left) / scale, y1 - (py - top) / scale],
    box: { x: left, y: top, width: scale * (x1 - x0), height: scale * (y1 - y0) },
  };
}

/** One pixel a cell: the lowest nearly the ground's colour, the highest the text's. */
function paint(canvas: HTMLCanvasElement, seen: MeshHeights): void {
  const rows = seen.heights;
  canvas.width = rows[0]!.length;
  canvas.height = rows.length;
  const context = canvas.getContext("2d")!;
  context.fillStyle = getComputedStyle(canvas).color;
  const found = rows.flat().filter((z): z is number => z !== null);
  const low = Math.min(...found);
  const span = Math.max(...found) - low || 1;
  rows.forEach((row, j) => {
    row.forEach((z, i) => {
      if (z === null) return;
      context.globalAlpha = 0.1 + (0.6 * (z - low)) / span;
      context.fillRect(i, rows.length - 1 - j, 1, 1);
    });
  });
}

export function FromAbove() {
  const seen = heights.value;
  const edges = extent.value;
  if (!seen || !edges) {
    return (
      <div class="from-above empty">{!cutProblem.value && <span>Reading the mesh…</span>}</div>
    );
  }
  return <Drawing seen={seen} edges={edges} />;
}

type Grip = "plane" | "tip";

function Drawing({ seen, edges }: { seen: MeshHeights; edges: [Vec2, Vec2] }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const svg = useRef<SVGSVGElement>(null);
  const [grip, setGrip] = useState<Grip | null>(null);
  useEffect(() => paint(canvas.current!, seen), [seen]);
  const place = placing(edges);
  const { through, heading } = cut.value;
  const ahead: Vec2 = [Math.cos(heading), -Math.sin(heading)];
  const zero = place.at(through);
  const [tail, tip] = ends(zero, ahead);
  const pointer = (event: PointerEvent): Vec2 => {
    const box = svg.current!.getBoundingClientRect();
    return place.back([
      ((event.clientX - box.left) / box.width) * WIDTH,
      ((event.clientY - box.top) / box.height) * HEIGHT,
    ]);
  };
  const follow = (event: PointerEvent, by: Grip | null) => {
    if (by === "plane") moveThrough(pointer(event));
    else if (by === "tip") pointAt(pointer(event));
  };
  const take = (by: Grip) => (event: PointerEvent) => {
    event.stopPropagation();
    svg.current!.setPointerCapture(event.pointerId);
    setGrip(by);
    if (by === "plane") follow(event, by);
  };
  return (
    <div class="from-above">
      <canvas
        ref={canvas}
        style={{
          left: `${(100 * place.box.x) / WIDTH}%`,
          top: `${(100 * place.box.y) / HEIGHT}%`,
          width: `${(100 * place.box.width) / WIDTH}%`,
          height: `${(100 * place.box.height) / HEIGHT}%`,
        }}
      />
      <svg
        ref={svg}
        viewBox={`0 0 ${WIDTH} ${HEIGHT}`}
        data-grip={grip}
        onPointerDown={take("plane")}
        onPointerMove={(event) => follow(event, grip)}
        onPointerUp={() => setGrip(null)}
        onPointerCancel={() => setGrip(null)}
      >
        <title>The mesh from above with the plane that cuts it</title>
        <rect class="mesh-box" {...place.box} />
        <Extent edges={edges} box={place.box} />
        <g
          class="plane"
          role="slider"
          tabindex={0}
          aria-label="Plane"
          aria-orientation="vertical"
          aria-valuemin={edges[1][0]}
          aria-valuemax={edges[1][1]}
          aria-valuenow={through[1]}
          aria-valuetext={`y ${fixed(through[1], 3)} m`}
          onKeyDown={(event) => {
            const by = { ArrowUp: 1, ArrowDown: -1 }[event.key];
            if (!by) return;
            event.preventDefault();
            move({ through: [through[0], through[1] + by * (event.shiftKey ? 0.1 : 0.01)] });
          }}
        >
          <line class="touch" x1={tail[0]} y1={tail[1]} x2={tip[0]} y2={tip[1]} />
          <line x1={tail[0]} y1={tail[1]} x2={tip[0]} y2={tip[1]} />
        </g>
        <circle class="zero" cx={zero[0]} cy={zero[1]} r={3} />
        <g
          class="tip"
          role="slider"
          tabindex={0}
          aria-label="Heading"
          aria-valuemin={-180}
          aria-valuemax={180}
          aria-valuenow={degrees(heading)}
          aria-valuetext={`${fixed(degrees(heading), 1)}°`}
          transform={`translate(${tip[0]} ${tip[1]}) rotate(${-degrees(heading)})`}
          onPointerDown={take("tip")}
          onKeyDown={(event) => {
            const by = { ArrowLeft: 1, ArrowRight: -1, ArrowUp: 1, ArrowDown: -1 }[event.key];
            if (!by) return;
            event.preventDefault();
            const turned = heading + (by * (event.shiftKey ? 5 : 0.5) * Math.PI) / 180;
            move({ heading: Math.atan2(Math.sin(turned), Math.cos(turned)) });
          }}
        >
          <circle class="touch" r={14} />
          <path d="M4 0-8 6v-12z" />
        </g>
      </svg>
    </div>
  );
}

/** Where a line through `p` leaves the drawing, with room for the arrow's tip. */
function ends([px, py]: Vec2, [dx, dy]: Vec2): [Vec2, Vec2] {
  const room = 12;
  const reach = (p: number, d: number, size: number): Vec2 => {
    if (Math.abs(d) < 1e-9) return [-Infinity, Infinity];
    const [a, b] = [(room - p) / d, (size - room - p) / d];
    return a < b ? [a, b] : [b, a];
  };
  const [x, y] = [reach(px, dx, WIDTH), reach(py, dy, HEIGHT)];
  const [from, to] = [Math.max(x[0], y[0]), Math.min(x[1], y[1])];
  return [
    [px + from * dx, py + from * dy],
    [px + to * dx, py + to * dy],
  ];
}

function Extent({
  edges: [[x0, x1], [y0, y1]],
  box,
}: {
  edges: [Vec2, Vec2];
  box: { x: number; y: number; width: number; height: number };
}) {
  return (
    <g class="scale">
      <text x={box.x} y={box.y + box.height + 16}>
        x {fixed(x0, 2)} to {fixed(x1, 2)} m
      </text>
      <text x={box.x} y={box.y - 8}>
        y {fixed(y0, 2)} to {fixed(y1, 2)} m
      </text>
    </g>
  );
}
