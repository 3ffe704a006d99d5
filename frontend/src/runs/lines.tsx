/** Lines of several results on common axes: colour and dash tell them apart. */

import { fixed } from "../geometry/format";
import { decimate } from "../plots/decimate";
import { letter, styleOf } from "./pins";

export interface PinLine {
  /** Place among the pins. */
  place: number;
  x: readonly number[];
  y: readonly number[];
}

const BUCKETS = 300;

/** Round values, about `most` of them, that span lo to hi. */
function ticks(lo: number, hi: number, most: number): number[] {
  const rough = Math.max(hi - lo, 1e-9) / most;
  const size = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * size).find((s) => s >= rough)!;
  const first = Math.ceil(lo / step - 1e-9);
  const count = Math.floor(hi / step + 1e-9) - first + 1;
  return Array.from({ length: count }, (_, i) => Number(((first + i) * step).toPrecision(6)));
}

const label = (value: number) => fixed(value, Number.isInteger(value) ? 0 : 1);

interface Props {
  title: string;
  unit: string;
  xUnit: string;
  lines: readonly PinLine[];
}

export function Lines({ title, unit, xUnit, lines }: Props) {
  const drawn = lines.map((line) => {
    const last = line.x.at(-1) ?? 0;
    const [x, y] = decimate([line.x, line.y], line.x[0] ?? 0, last, BUCKETS);
    return { place: line.place, x: x!, y: y! };
  });
  const end = Math.max(1e-6, ...drawn.flatMap((line) => line.x));
  const ys = drawn.flatMap((line) => line.y).filter(Number.isFinite);
  const room = 0.06 * Math.max(Math.max(...ys) - Math.min(...ys), 1e-3);
  const lo = Math.min(0, ...ys) - room;
  const hi = Math.max(0, ...ys) + room;
  const up = (value: number) => (1 - (value - lo) / (hi - lo)) * 100;
  return (
    <section class="ovl" aria-label={title}>
      <h3>
        {title} <small>{unit}</small>
      </h3>
      <div class="ovl-plot">
        {ticks(lo, hi, 4).map((value) => (
          <span key={value} class="ovl-y" style={{ top: `${up(value)}%` }}>
            {label(value)}
          </span>
        ))}
        {ticks(0, end, 5).map((value) => (
          <span key={value} class="ovl-x" style={{ left: `${(value / end) * 100}%` }}>
            {label(value)}
          </span>
        ))}
        <span class="ovl-unit">{xUnit}</span>
        <svg
          viewBox="0 0 100 100"
          preserveAspectRatio="none"
          role="img"
          aria-label={said(title, drawn)}
        >
          {ticks(lo, hi, 4).map((value) => (
            <line key={value} x1="0" x2="100" y1={up(value)} y2={up(value)} />
          ))}
          {drawn.map((line) => (
            <polyline
              key={line.place}
              points={line.x
                .flatMap((x, i) => {
                  const y = up(line.y[i]!);
                  return Number.isFinite(y)
                    ? [`${((x / end) * 100).toFixed(2)},${y.toFixed(2)}`]
                    : [];
                })
                .join(" ")}
              style={pen(line.place)}
            />
          ))}
        </svg>
      </div>
    </section>
  );
}

const said = (title: string, lines: readonly PinLine[]) =>
  `${title} of ${lines.map((line) => letter(line.place)).join(", ")}`;

export function pen(place: number) {
  const { color, dash } = styleOf(place);
  return { stroke: color, "stroke-dasharray": dash || "none" };
}
