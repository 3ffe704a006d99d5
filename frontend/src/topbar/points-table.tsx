/** The terrain as a table of x and z: to type, to paste into, to take along as CSV or YAML. */

import { useEffect, useRef } from "preact/hooks";
import { fixed } from "../geometry/format";
import { ImportProblem } from "../import/import-problem";
import { pastedFile } from "../import/kind";
import { importProblem, takeFile } from "../import/take";
import { addVertex, moveVertices, removeVertices } from "../profile-editor/edits";
import { names } from "../profile-editor/vertices";
import { commit, draft, drawing } from "../state/drawing";
import { pointsOpen } from "../state/view";
import { Icon } from "../ui/icon";
import { IconButton } from "../ui/icon-button";
import { NumberField } from "../ui/number-field";
import { saveFile } from "../ui/save-file";

const number = (v: number) => String(Number(v.toFixed(4)));

export const asCsv = (): string =>
  `x,z\n${drawing
    .peek()
    .points.map(([x, z]) => `${number(x)},${number(z)}`)
    .join("\n")}\n`;

export function asYaml(): string {
  const { name, friction, points } = drawing.peek();
  const rows = points.map(([x, z]) => `- [${number(x)}, ${number(z)}]`).join("\n");
  return `name: ${JSON.stringify(name)}\nfriction: ${number(friction)}\npoints:\n${rows}\n`;
}

export function PointsTable() {
  const dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => dialog.current?.showModal(), []);
  const { points, name } = drawing.value;
  const set = (i: number, axis: 0 | 1) => (value: number) => {
    const by = value - drawing.peek().points[i]![axis];
    draft({
      points: moveVertices(drawing.peek().points, [i], axis === 0 ? by : 0, axis === 1 ? by : 0),
    });
  };
  const paste = (event: ClipboardEvent) => {
    const text = event.clipboardData?.getData("text/plain") ?? "";
    // One number is for the field that has the focus; more are a terrain.
    if (!/[\s,;]/.test(text.trim())) return;
    event.preventDefault();
    event.stopPropagation();
    void takeFile(pastedFile(text), "table");
  };
  return (
    <dialog
      ref={dialog}
      class="tag points-sheet"
      aria-labelledby="points-title"
      onPaste={paste}
      onClose={() => {
        pointsOpen.value = false;
        importProblem.value = null;
      }}
    >
      <h2 id="points-title">Points of {name}</h2>
      <p>Metres. Paste two columns, x and z, to replace them all.</p>
      {/* biome-ignore lint/a11y/noNoninteractiveTabindex: a scrolling region must take the focus */}
      <section class="scroll" tabIndex={0} aria-label="Corners">
        <table>
          <thead>
            <tr>
              <th scope="col">x, m</th>
              <th scope="col">z, m</th>
              <th scope="col">corner</th>
              <th scope="col">
                <span class="sr">Change</span>
              </th>
            </tr>
          </thead>
          <tbody>
            {points.map((p, i) => (
              <tr key={i}>
                {([0, 1] as const).map((axis) => (
                  <td key={axis}>
                    <NumberField
                      label={`${axis === 0 ? "x" : "z"} of point ${i + 1} in metres`}
                      value={p[axis]}
                      min={axis === 0 ? (points[i - 1]?.[0] ?? -100) : -100}
                      max={axis === 0 ? (points[i + 1]?.[0] ?? 100) : 100}
                      step={0.005}
                      format={(v) => fixed(v, 3)}
                      onChange={set(i, axis)}
                      onDone={() => commit()}
                    />
                  </td>
                ))}
                <td>{names.value[i]}</td>
                <td class="row-acts">
                  <IconButton
                    action={() => commit({ points: addVertex(points, i).points })}
                    label={`Add a point after point ${i + 1}`}
                    icon="plus"
                    off={i === points.length - 1}
                  />
                  <IconButton
                    action={() => commit({ points: removeVertices(points, [i]) })}
                    label={`Delete point ${i + 1}`}
                    icon="trash"
                    off={points.length < 3}
                  />
                </td>
              </tr>
            ))}
          </tbody>
        </table>
      </section>
      <ImportProblem place="table" />
      <form method="dialog" class="acts end">
        <button
          type="button"
          class="btn"
          onClick={() => saveFile(`${name}.csv`, asCsv(), "text/csv")}
        >
          <Icon name="download" />
          CSV
        </button>
        <button
          type="button"
          class="btn"
          onClick={() => saveFile(`${name}.yaml`, asYaml(), "application/yaml")}
        >
          <Icon name="download" />
          YAML
        </button>
        <button type="submit" class="btn pri">
          Close
        </button>
      </form>
    </dialog>
  );
}
