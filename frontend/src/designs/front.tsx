/** What designs reach: two aims against each other, or one aim over the designs as they were tried. */

import { signal } from "@preact/signals";
import { useRef } from "preact/hooks";
import { roundStep } from "../map/scale";
import { useMeasured } from "../ui/measured";
import { useRoving } from "../ui/roving";
import { openDesign } from "./open-robot";
import { across, aimName, type Candidate, front, inView, pointAt, search } from "./state";
import { withUnit, wordsOf } from "./words";

/** Around the drawing [px]. */
const MARGIN = { left: 64, right: 24, top: 24, bottom: 48 };
const TICKS = 6;
/** Free at both ends of an axis, as a share of what is shown. */
const AIR = 0.06;

const room = signal({ width: 0, height: 0 });

interface Axis {
  title: string;
  better: string;
  of: (candidate: Candidate, number: number) => number | null;
  show: (value: number) => string;
}

/** The axes of the drawing: with one aim the designs' order goes across. */
function axes(): [Axis, Axis] | null {
  const shown = search.value;
  if (!shown) return null;
  const { aims } = shown.design;
  const aimAxis = (k: number): Axis => {
    const name = aimName(aims[k]!);
    const { title, unit, show } = wordsOf(name);
    return {
      title: unit ? `${title}, ${unit}` : title,
      better: aims[k]!.minimise ? "less is better" : "more is better",
      of: (each) => each.aims[name] ?? null,
      show,
    };
  };
  if (aims.length > 1) return [aimAxis(across.value[0]), aimAxis(across.value[1])];
  const order: Axis = {
    title: "Designs as they were tried",
    better: "",
    of: (_, number) => number + 1,
    show: (v) => v.toFixed(0),
  };
  return [order, aimAxis(0)];
}

interface Scale {
  at: (value: number) => number;
  ticks: number[];
}

function scaleOf(values: number[], from: number, to: number): Scale {
  let [low, high] = [Math.min(...values), Math.max(...values)];
  if (!(high > low))
    [low, high] = [low - (Math.abs(low) || 1) * 0.1, high + (Math.abs(high) || 1) * 0.1];
  const air = (high - low) * AIR;
  [low, high] = [low - air, high + air];
  const step = roundStep(high - low, TICKS);
  const ticks: number[] = [];
  for (let k = Math.ceil(low / step); k * step <= high; k++) ticks.push(k * step);
  return { at: (v) => from + ((v - low) / (high - low)) * (to - from), ticks };
}

interface Point {
  number: number;
  x: number;
  y: number;
  candidate: Candidate;
}

export function Front() {
  const holder = useMeasured((element) => {
    room.value = { width: element.clientWidth, height: element.clientHeight };
  });
  return (
    <div class="design-front" ref={holder}>
      <Drawing />
    </div>
  );
}

function Drawing() {
  const svg = useRef<SVGSVGElement>(null);
  useRoving(svg, "[role=button]");
  const { width, height } = room.value;
  const pair = axes();
  const shown = search.value;
  if (!pair || !shown || width === 0) return null;
  const [across, up] = pair;
  const passed = shown.candidates.flatMap((candidate, number) => {
    const [x, y] = [across.of(candidate, number), up.of(candidate, number)];
    return candidate.passed && x !== null && y !== null ? [{ number, x, y, candidate }] : [];
  });
  if (passed.length === 0) return null;
  const xs = scaleOf(
    passed.map((p) => p.x),
    MARGIN.left,
    width - MARGIN.right,
  );
  const ys = scaleOf(
    passed.map((p) => p.y),
    height - MARGIN.bottom,
    MARGIN.top,
  );
  const points: Point[] = passed.map((p) => ({ ...p, x: xs.at(p.x), y: ys.at(p.y) }));
  const best = front.value.flatMap((n) => points.find((p) => p.number === n) ?? []);
  return (
    <svg ref={svg} width={width} height={height} role="group" aria-label="Front of the designs">
      <g class="grid">
        {xs.ticks.map((v) => (
          <g key={v}>
            <path d={`M${xs.at(v)} ${MARGIN.top}V${height - MARGIN.bottom}`} />
            <text x={xs.at(v)} y={height - MARGIN.bottom + 16} text-anchor="middle">
              {across.show(v)}
            </text>
          </g>
        ))}
        {ys.ticks.map((v) => (
          <g key={v}>
            <path d={`M${MARGIN.left} ${ys.at(v)}H${width - MARGIN.right}`} />
            <text x={MARGIN.left - 8} y={ys.at(v) + 4} text-anchor="end">
              {up.show(v)}
            </text>
          </g>
        ))}
        <text class="name" x={(width + MARGIN.left) / 2} y={height - 10} text-anchor="middle">
          {across.title}
          {across.better && ` · ${across.better}`}
        </text>
        <text
          class="name"
          transform={`translate(14 ${(height - MARGIN.bottom) / 2}) rotate(-90)`}
          text-anchor="middle"
        >
          {up.title} · {up.better}
        </text>
      </g>
      {shown.design.aims.length === 2 && (
        <polyline class="line" points={best.map((p) => `${p.x},${p.y}`).join(" ")} />
      )}
      {points.map((point) => !point.candidate.best && <Beaten key={point.number} {...point} />)}
      {best.map((point) => (
        <Best key={point.number} {...point} />
      ))}
    </svg>
  );
}

function Beaten({ number, x, y }: Point) {
  return (
    <circle
      class={inView.value === number ? "beaten seen" : "beaten"}
      cx={x}
      cy={y}
      r={4}
      onPointerEnter={() => pointAt(number)}
    />
  );
}

function Best({ number, x, y, candidate }: Point) {
  const reached = Object.entries(candidate.aims).map(
    ([name, value]) => `${wordsOf(name).title} ${withUnit(name, value ?? Number.NaN)}`,
  );
  return (
    <g
      role="button"
      tabIndex={-1}
      class={inView.value === number ? "best seen" : "best"}
      aria-label={`${reached.join(", ")}: open this robot`}
      onPointerEnter={() => pointAt(number)}
      onFocus={() => pointAt(number)}
      onClick={() => openDesign(number)}
      onKeyDown={(event) => {
        if (event.key !== "Enter" && event.key !== " ") return;
        event.preventDefault();
        event.stopPropagation();
        openDesign(number);
      }}
    >
      <circle class="grip" cx={x} cy={y} r={12} />
      <circle class="dot" cx={x} cy={y} r={5.5} />
    </g>
  );
}
