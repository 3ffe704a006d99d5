/** Four margins below the profile, on its x axis: a thin one lies under the spot that causes it. */

import type { Plan, Problem } from "../api/types";
import { poseTimes } from "../geometry/frames";
import { plan, planKept, preview } from "../state/planning";
import { frame, playing, seek } from "../state/playback";
import {
  CLASS_NAMES,
  MARGINS,
  type MarginClass,
  type MarginName,
  marginClass,
  worst,
} from "./margins";
import { canvasBox, projection, STRIP, size } from "./viewport";

const LABELS = 147;
const LEGEND = 90;
const ROW = 12;
const PITCH = 16;
const VISIBLE = 2;

/** Path data of a row, one string a class: bars between the middles of neighbouring poses. */
function bars(shown: Plan, row: number, top: number, left: number, right: number): string[] {
  const kind = MARGINS[row]!;
  const { px } = projection.value;
  const paths = ["", "", "", ""];
  const xs = shown.poses.map((p) => px(p.x_c));
  const y = top + row * PITCH;
  let from = Math.max(left, xs[0] ?? left);
  let open: MarginClass | null = null;
  const close = (x: number) => {
    // Short and thin is what matters most: it stays visible at any zoom.
    const least = open !== null && open < 3 ? from + VISIBLE : from;
    const to = Math.min(right, Math.max(left, x, least));
    if (open !== null && to > from)
      paths[open] += `M${from.toFixed(1)} ${y}H${to.toFixed(1)}v${ROW}H${from.toFixed(1)}z`;
    from = Math.max(from, to);
  };
  shown.poses.forEach((pose, i) => {
    const next = marginClass(kind, pose.margins[kind.name]);
    if (next !== open) {
      if (open !== null) close((xs[i - 1]! + xs[i]!) / 2);
      open = next;
    }
  });
  close(xs[xs.length - 1] ?? left);
  return paths;
}

export function MarginStrip() {
  const { width, height } = size.value;
  const narrow = width < 800;
  const top = height - STRIP + 8;
  const left = narrow ? 122 : LABELS;
  const right = width - (narrow ? 62 : LEGEND);
  const shown = planKept.value ? plan.value : null;
  const { px } = projection.value;
  const last = shown?.poses[shown.poses.length - 1];
  const stop = shown?.problem && last ? Math.min(right, Math.max(left, px(last.x_c))) : null;

  const scrub = (event: PointerEvent) => {
    if (!shown || (event.type === "pointermove" && event.buttons !== 1)) return;
    event.stopPropagation();
    const svg = (event.currentTarget as SVGElement).ownerSVGElement!;
    if (event.type === "pointerdown")
      (event.currentTarget as SVGElement).setPointerCapture(event.pointerId);
    const x = event.clientX - svg.getBoundingClientRect().left;
    let best = 0;
    shown.poses.forEach((p, i) => {
      if (Math.abs(px(p.x_c) - x) < Math.abs(px(shown.poses[best]!.x_c) - x)) best = i;
    });
    playing.value = false;
    seek(poseTimes(shown)[best] ?? 0);
  };

  return (
    <g class="strip">
      <rect class="stbg" x={0} y={height - STRIP} width={width} height={STRIP} />
      <path class="edge" d={`M0 ${height - STRIP + 0.5}H${width}`} />
      {MARGINS.map((kind, row) => {
        const y = top + row * PITCH;
        const value = shown && shown.poses.length > 0 ? worst(shown.poses, kind.name) : null;
        const bad = value !== null && marginClass(kind, value) === 0;
        const paths = shown ? bars(shown, row, top, left, right) : ["", "", "", ""];
        const text = value === null ? "–" : kind.read(value, shown!);
        return (
          <g key={kind.name}>
            <text class="sl" x={12} y={y + 10}>
              {kind.title}
            </text>
            <text class={bad ? "sv bad" : "sv"} x={left - 10} y={y + 10} text-anchor="end">
              {narrow ? text.split(" / ")[0] : text}
            </text>
            <rect class="s0" x={left} y={y} width={Math.max(0, right - left)} height={ROW} rx={2} />
            <g class="bars">
              {paths.map((d, c) => (
                <path key={c} class={`m${c}`} d={d} />
              ))}
              {stop !== null && (
                <Beyond
                  from={stop}
                  to={right}
                  y={y}
                  bad={problemMargin(shown!.problem!) === kind.name}
                />
              )}
            </g>
            <KeyTicks row={row} y={y} left={left} right={right} />
          </g>
        );
      })}
      {stop !== null && right - stop > 120 && (
        <text class="np" x={(stop + right) / 2 + 30} y={top + 2 * PITCH + 8} text-anchor="middle">
          not planned
        </text>
      )}
      {CLASS_NAMES.map((name, c) => (
        <g key={name}>
          <rect
            class={`m${c}`}
            x={right + 12}
            y={top + 2 + (3 - c) * PITCH}
            width={8}
            height={8}
            rx={2}
          />
          <text class="sl" x={right + 26} y={top + 10 + (3 - c) * PITCH}>
            {narrow && name === "critical" ? "crit" : name}
          </text>
        </g>
      ))}
      <rect
        class="scrubber"
        x={left}
        y={height - STRIP}
        width={Math.max(0, right - left)}
        height={STRIP}
        onPointerDown={scrub}
        onPointerMove={scrub}
      />
      <Cursor left={left} right={right} />
    </g>
  );
}

const TICK = 6;

/** Margins of the previewed key poses, over the dimmed bars of the older plan. */
function KeyTicks({
  row,
  y,
  left,
  right,
}: {
  row: number;
  y: number;
  left: number;
  right: number;
}) {
  const shown = preview.value;
  if (!shown) return null;
  const kind = MARGINS[row]!;
  return (
    <>
      {shown.poses.map((pose, i) => {
        const x = projection.value.px(pose.x_c);
        if (x < left || x > right) return null;
        const c = marginClass(kind, pose.margins[kind.name]);
        return <rect key={i} class={`m${c}`} x={x - TICK / 2} y={y} width={TICK} height={ROW} />;
      })}
    </>
  );
}

/** The margin that the problem is about; none of them tells of reach, joint range or height. */
function problemMargin({ kind, limit }: Problem): MarginName | null {
  if (kind === "statics") return limit?.quantity.startsWith("friction") ? "friction" : "com";
  return kind === "clearance" || kind === "torque" ? kind : null;
}

function Beyond({ from, to, y, bad }: { from: number; to: number; y: number; bad: boolean }) {
  const hatch = bad ? Math.min(100, to - from) : 0;
  return (
    <>
      <rect
        fill="url(#hatch)"
        x={from + hatch}
        y={y}
        width={Math.max(0, to - from - hatch)}
        height={ROW}
      />
      {bad && <rect fill="url(#hatch-bad)" x={from} y={y} width={hatch} height={ROW} />}
    </>
  );
}

function Cursor({ left, right }: { left: number; right: number }) {
  const now = frame.value;
  const { height } = size.value;
  if (!now) return null;
  const x = Math.min(right, Math.max(left, projection.value.px(now.x)));
  const y = canvasBox.value.bottom;
  return (
    <g class="tc" transform={`translate(${x.toFixed(1)} 0)`}>
      <path d={`M0 ${y + 2}V${height}`} />
      <path class="th" d={`M-5 ${y - 4}h10v5l-5 5l-5-5z`} />
    </g>
  );
}
