/** The map as a table: the same cells and words, for screen readers and for whoever wants numbers. */

import { fixed } from "../geometry/format";
import { PASSES, STOPPED } from "./cube";
import { openCell } from "./open-cell";
import { quantityOf, reasonWords } from "./quantities";
import { quantity, robotAxis } from "./state";
import { contents, shownAxes } from "./view";

/** Of a difference, infinite: only one of the two passes. */
function told(value: number, digits: number): string {
  const only = robotAxis.value?.values[value > 0 === quantityOf(quantity.value).rising ? 0 : 1];
  return Number.isFinite(value) ? fixed(value, digits) : `only ${only}`;
}

/** A quantity or an axis with its unit, if it has one; within a sentence if `inside`. */
function inUnit({ title, unit }: { title: string; unit: string }, inside = false): string {
  const name = inside ? title.toLowerCase() : title;
  return unit && unit !== "μ" ? `${name} in ${unit}` : name;
}

export function MapTable() {
  const axes = shownAxes.value;
  const kind = quantityOf(quantity.value);
  if (!axes) return null;
  const [x, y] = axes;
  const rows = y.values.map((_, j) => y.values.length - 1 - j);
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: it scrolls by keys
    <section class="map-table" aria-label="Map as a table" tabIndex={0}>
      {contents.value.list.map(({ field, values, title }, panel) => (
        <table key={title ?? ""}>
          <caption>
            {title ? `${title}: ` : ""}
            {inUnit(kind)}; down {inUnit(y.kind, true)}, across {inUnit(x.kind, true)}
          </caption>
          <thead>
            <tr>
              <td />
              {x.values.map((v) => (
                <th key={v} scope="col">
                  {fixed(v, x.kind.digits)}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {rows.map((j) => (
              <tr key={j}>
                <th scope="row">{fixed(y.values[j]!, y.kind.digits)}</th>
                {x.values.map((v, i) => {
                  const here = j * field.nx + i;
                  const verdict = field.coarse[here] === 1 ? field.verdict[here] : 0;
                  const value = values[here]!;
                  return (
                    <td key={v} class={verdict === STOPPED ? "no" : ""}>
                      <button
                        type="button"
                        tabIndex={-1}
                        onClick={() => void openCell({ panel, i, j })}
                      >
                        {verdict === STOPPED && reasonWords(field.reason[here]!)[1]}
                        {verdict === PASSES && told(value, kind.digits)}
                        {verdict !== PASSES && verdict !== STOPPED && "…"}
                      </button>
                    </td>
                  );
                })}
              </tr>
            ))}
          </tbody>
        </table>
      ))}
    </section>
  );
}
