/** Four margins as bars on the timeline's axis, each with its value at the cursor and its least. */

import type { Plan, Problem } from "../api/types";
import { poseTimes } from "../geometry/frames";
import {
  MARGINS,
  type MarginClass,
  type MarginName,
  marginClass,
  worst,
} from "../profile-editor/margins";
import { live } from "../state/live";
import { plan, planKept, preview } from "../state/planning";
import { duration, hoverTime, playing, poseIndex, seek } from "../state/playback";
import { axisKind, cursor, marks, shareOf, timeAt } from "./axis";
import { SpeedRow } from "./speed-row";

/** Bars are drawn in parts of the axis. */
const PARTS = 1000;
/** Short and thin is what matters most: it stays visible. */
const VISIBLE = 2;

/** Path data of a row, one string a class: bars between the middles of neighbouring poses. */
function bars(shown: Plan, row: number, at: readonly number[]): string[] {
  const kind = MARGINS[row]!;
  const paths = ["", "", "", ""];
  const xs = at.map((value) => shareOf(value) * PARTS);
  let from = xs[0] ?? 0;
  let open: MarginClass | null = null;
  const close = (x: number) => {
    const to = Math.min(PARTS, Math.max(x, open !== null && open < 3 ? from + VISIBLE : from));
    if (open !== null && to > from)
      paths[open] += `M${from.toFixed(1)} 0H${to.toFixed(1)}v1H${from.toFixed(1)}z`;
    from = Math.max(from, to);
  };
  let reached = 0;
  for (; reached < xs.length && !Number.isNaN(at[reached]!); reached++) {
    const next = marginClass(kind, shown.poses[reached]!.margins[kind.name]);
    if (next === open) continue;
    if (open !== null) close((xs[reached - 1]! + xs[reached]!) / 2);
    open = next;
  }
  if (reached > 0) close(xs[reached - 1]!);
  return paths;
}

/** The margin that the problem is about; none of them tells of reach, joint range or height. */
function problemMargin({ kind, limit }: Problem): MarginName | null {
  if (kind === "statics") return limit?.quantity.startsWith("friction") ? "friction" : "com";
  return kind === "clearance" || kind === "torque" ? kind : null;
}

/** Where the bars end, before the axis does. */
function stopOf(shown: Plan | null, at: readonly number[]): number | null {
  if (!shown || at.length === 0) return null;
  const lost = at.findIndex((value) => Number.isNaN(value));
  if (lost < 0 && !shown.problem) return null;
  return shareOf(at[(lost < 0 ? at.length : lost) - 1] ?? 0);
}

export function MarginRows() {
  const shown = planKept.value ? plan.value : null;
  const at = marks.value;
  const stop = stopOf(shown, at);
  return (
    <div class="rows">
      {MARGINS.map((kind, row) => (
        <div class="row" key={kind.name}>
          <Label row={row} shown={shown} />
          <div class="track">
            <svg viewBox={`0 0 ${PARTS} 1`} preserveAspectRatio="none" aria-hidden="true">
              {shown &&
                bars(shown, row, at).map((d, c) => <path key={c} class={`m${c} bars`} d={d} />)}
              <Previewed row={row} />
            </svg>
            {stop !== null && (
              <Beyond
                from={stop}
                bad={Boolean(shown?.problem && problemMargin(shown.problem) === kind.name)}
                text={row === 2 ? beyondText(shown) : ""}
              />
            )}
          </div>
        </div>
      ))}
      <SpeedRow />
      <Scrub />
    </div>
  );
}

function beyondText(shown: Plan | null): string {
  if (shown?.problem) return "not planned";
  return live.value?.outcome === "running" ? "still to come" : "not reached";
}

/** Title, value at the cursor, and the least of the plan: most where less is better. */
function Label({ row, shown }: { row: number; shown: Plan | null }) {
  const kind = MARGINS[row]!;
  const pose = shown?.poses[poseIndex.value];
  if (!shown || !pose) {
    return (
      <div class="ml">
        <span>{kind.title}</span>
        <b>–</b>
        <small>{kind.unit}</small>
      </div>
    );
  }
  const least = worst(shown.poses, kind.name);
  const bad = marginClass(kind, least) === 0;
  return (
    <div class="ml" title={kind.hint}>
      <span>{kind.title}</span>
      <b>
        {kind.read(pose.margins[kind.name], shown)}
        {kind.unit && <span class="unit"> {kind.unit}</span>}
      </b>
      <small class={bad ? "x" : ""}>
        {kind.extreme} {kind.read(least, shown)} {kind.unit}
      </small>
    </div>
  );
}

/** Margins of the previewed key poses, over the dimmed bars of the older plan. */
function Previewed({ row }: { row: number }) {
  const shown = preview.value;
  if (!shown) return null;
  const kind = MARGINS[row]!;
  const times = poseTimes(shown);
  return (
    <>
      {shown.poses.map((pose, i) => {
        const x = shareOf(axisKind.value === "time" ? (times[i] ?? 0) : pose.x_c) * PARTS;
        const c = marginClass(kind, pose.margins[kind.name]);
        return <rect key={i} class={`m${c}`} x={x - 3} y={0} width={6} height={1} />;
      })}
    </>
  );
}

function Beyond({ from, bad, text }: { from: number; bad: boolean; text: string }) {
  return (
    <div class={bad ? "beyond bad" : "beyond"} style={{ left: `${from * 100}%` }}>
      {text && from < 0.85 && <span>{text}</span>}
    </div>
  );
}

/** The pointer on the rows: hover previews, a drag sets the clock; keys do that on the timeline. */
function Scrub() {
  const at = (event: PointerEvent) => {
    const rect = (event.currentTarget as HTMLElement).getBoundingClientRect();
    return timeAt((event.clientX - rect.left) / rect.width);
  };
  const onPointerMove = (event: PointerEvent) => {
    if (event.buttons === 1) seek(at(event));
    else if (!playing.peek() && event.pointerType === "mouse")
      hoverTime.value = Math.min(at(event), duration.peek());
  };
  return (
    <div
      class="rows-scrub"
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        playing.value = false;
        hoverTime.value = null;
        seek(at(event));
      }}
      onPointerMove={onPointerMove}
      onPointerLeave={() => {
        hoverTime.value = null;
      }}
    >
      {duration.value > 0 && <i style={{ left: `${cursor.value * 100}%` }} />}
    </div>
  );
}
