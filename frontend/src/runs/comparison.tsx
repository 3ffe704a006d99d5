/** Figures of the pinned results side by side, and as a CSV file. */

import type { Entry } from "../api/stored";
import { degrees, fixed } from "../geometry/format";
import { stated } from "../profile-editor/margins";
import { chips } from "./chips";
import { letter, styleOf } from "./pins";
import { outcome } from "./row";
import { title } from "./store";

interface Figure {
  name: string;
  unit: string;
  digits: number;
  of: (entry: Entry) => number | null | undefined;
}

const FIGURES: readonly Figure[] = [
  {
    name: "Pitch error, most",
    unit: "°",
    digits: 2,
    of: ({ summary: s }) => s.metrics && degrees(s.metrics.pitch_error_max),
  },
  { name: "Peak leg torque", unit: "Nm", digits: 1, of: (e) => e.summary.metrics?.torque_peak },
  { name: "Least CoM margin", unit: "mm", digits: 0, of: (e) => mm(e.summary.margins?.com) },
  { name: "Least clearance", unit: "mm", digits: 0, of: (e) => mm(e.summary.margins?.clearance) },
  { name: "Time", unit: "s", digits: 1, of: (e) => e.summary.duration },
  { name: "Mean speed", unit: "m/s", digits: 3, of: (e) => e.summary.metrics?.speed_mean },
  { name: "Energy", unit: "J", digits: 0, of: (e) => e.summary.metrics?.energy },
  { name: "Cost of transport", unit: "", digits: 2, of: (e) => e.summary.cost_of_transport },
  { name: "Energy, planned", unit: "J", digits: 0, of: (e) => e.summary.planned_energy },
  {
    name: "Cost of transport, planned",
    unit: "",
    digits: 2,
    of: (e) => e.summary.planned_cost_of_transport,
  },
];

const mm = (metres: number | undefined) =>
  metres === undefined ? undefined : stated(metres) * 1000;
const known = (value: number | null | undefined): value is number =>
  value !== null && value !== undefined && Number.isFinite(value);

export function Comparison({ entries }: { entries: readonly Entry[] }) {
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: a scrolling region must take the focus
    <section class="cmp-table" tabIndex={0} aria-label="Comparison">
      <table>
        <thead>
          <tr>
            <th scope="col">
              <span class="sr">Figure</span>
            </th>
            {entries.map((entry, i) => (
              <th key={entry.id} scope="col" title={chips(entry).join(", ")}>
                <i class="pin" style={{ background: styleOf(i).color }}>
                  {letter(i)}
                </i>
                <small>{title(entry)}</small>
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          <tr>
            <th scope="row">Outcome</th>
            {entries.map((entry) => (
              <td key={entry.id}>{outcome(entry)}</td>
            ))}
          </tr>
          {FIGURES.map((figure) => (
            <tr key={figure.name}>
              <th scope="row">{figure.name}</th>
              {entries.map((entry) => {
                const value = figure.of(entry);
                const { unit, digits } = figure;
                const ending = unit === "°" ? unit : unit && ` ${unit}`;
                const text = known(value) ? fixed(value, digits) + ending : "–";
                return <td key={entry.id}>{text}</td>;
              })}
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}

const quoted = (text: string) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

/** One row a result, one column a figure, units in the head. */
export function csv(entries: readonly Entry[]): string {
  const head = ["pin", "id", "name", "terrain", "robot", "settings", "outcome"];
  const figures = FIGURES.map(({ name, unit }) => (unit ? `${name} [${unit}]` : name));
  const rows = entries.map((entry, i) => [
    letter(i),
    entry.id,
    entry.name,
    entry.summary.terrain,
    entry.summary.robot,
    chips(entry).join("; "),
    outcome(entry),
    ...FIGURES.map((figure) => {
      const value = figure.of(entry);
      return known(value) ? String(Number(value.toPrecision(8))) : "";
    }),
  ]);
  return `${[[...head, ...figures], ...rows].map((row) => row.map(quoted).join(",")).join("\n")}\n`;
}
