/** What a plot's header offers: its values as a table, and its picture and numbers as files. */

import type { ReadonlySignal } from "@preact/signals";
import { fixed } from "../geometry/format";
import { interpolate } from "../geometry/frames";
import { Icon } from "../ui/icon";
import { Menu, MenuItem } from "../ui/menu";
import type { Panel } from "./lines";
import { type PlotFormat, savePlot } from "./save";

const FORMATS: [PlotFormat, string][] = [
  ["png", "picture"],
  ["svg", "vector picture"],
  ["csv", "all samples"],
];

export function SaveMenu({ panel }: { panel: ReadonlySignal<Panel> }) {
  return (
    <Menu
      label={`Save ${panel.peek().title}`}
      button={<Icon name="download" />}
      buttonClass="t ico"
      panelClass="up"
      align="right"
    >
      {(close) =>
        FORMATS.map(([format, note]) => (
          <MenuItem
            key={format}
            onChoose={() => {
              void savePlot(panel.peek(), format);
              close();
            }}
          >
            {format.toUpperCase()} <small>{note}</small>
          </MenuItem>
        ))
      }
    </Menu>
  );
}

const ROWS = 24;

export function TableMenu({ panel }: { panel: ReadonlySignal<Panel> }) {
  return (
    <Menu
      label={`${panel.peek().title} as a table`}
      button={<Icon name="table" />}
      buttonClass="t ico tbl"
      panelClass="values up"
      kind="dialog"
      align="right"
    >
      {() => <Table panel={panel.value} />}
    </Menu>
  );
}

function Table({ panel }: { panel: Panel }) {
  const lines = panel.halves.flat();
  const end = panel.time[panel.time.length - 1] ?? 0;
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: a scrolling region must take the focus
    <section class="scroll" tabIndex={0} aria-label={`Values of ${panel.title}`}>
      <table>
        <thead>
          <tr>
            <th scope="col">s</th>
            {lines.map((line) => (
              <th key={line.label} scope="col">
                {line.label} {line.read?.unit ?? panel.unit}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {Array.from({ length: ROWS + 1 }, (_, i) => (end * i) / ROWS).map((t) => (
            <tr key={t}>
              <td>{fixed(t, 2)}</td>
              {lines.map((line) => (
                <td key={line.label}>
                  {fixed(
                    interpolate(panel.time, line.raw ?? line.values, t),
                    line.read?.digits ?? 1,
                  )}
                </td>
              ))}
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}
