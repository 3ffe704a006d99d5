/** A mesh becomes a profile: where to cut it, seen from above, and what that gives. */

import { useEffect, useRef } from "preact/hooks";
import { degrees, fixed, setting } from "../geometry/format";
import { NumberField } from "../ui/number-field";
import { closeCut, cut, heights, meshFile, move, takeCut, turnUp, upToDate } from "./cut";
import { CutProfile } from "./cut-profile";
import { FromAbove } from "./from-above";

export function CutDialog() {
  const dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => dialog.current?.showModal(), []);
  const submit = (event: Event) => {
    event.preventDefault();
    takeCut();
  };
  return (
    <dialog ref={dialog} class="tag cut" aria-labelledby="cut-title" onClose={closeCut}>
      <form onSubmit={submit}>
        <h2 id="cut-title">Cut {meshFile.value?.name} into a profile</h2>
        <div class="cut-halves">
          <FromAbove />
          <Numbers />
        </div>
        <CutProfile />
        <div class="acts end">
          <button type="button" class="btn" onClick={closeCut}>
            Cancel
          </button>
          <button type="submit" class="btn pri" disabled={!upToDate.value}>
            Import
          </button>
        </div>
      </form>
    </dialog>
  );
}

function Numbers() {
  const { through, heading, scale, up } = cut.value;
  const off = heights.value === null;
  const metres = (v: number) => fixed(v, 3);
  return (
    <div class="cut-numbers">
      <p>Drag the plane, or the tip of its arrow to turn it. The upper edge becomes the ground.</p>
      <Row text="Plane at y, m">
        <NumberField
          label="Plane at y in metres"
          value={through[1]}
          min={-1000}
          max={1000}
          step={0.05}
          format={metres}
          disabled={off}
          onChange={(y) => move({ through: [through[0], y] })}
        />
      </Row>
      <Row text="Heading about z, °">
        <NumberField
          label="Heading in degrees"
          value={degrees(heading)}
          min={-180}
          max={180}
          step={5}
          format={(v) => fixed(v, 1)}
          disabled={off}
          onChange={(v) => move({ heading: (v * Math.PI) / 180 })}
        />
      </Row>
      <Row text="The profile's 0 is at x, m">
        <NumberField
          label="The profile's zero is at x in metres"
          value={through[0]}
          min={-1e6}
          max={1e6}
          step={0.05}
          format={metres}
          disabled={off}
          onChange={(x) => move({ through: [x, through[1]] })}
        />
      </Row>
      <Row text="Metres per unit of the file">
        <NumberField
          label="Metres per unit of the file"
          value={scale}
          min={0.0001}
          max={1000}
          format={setting}
          disabled={off}
          onChange={(v) => move({ scale: v })}
        />
      </Row>
      <div class="frow">
        <span id="cut-up">Axis that points up</span>
        <span class="seg" role="group" aria-labelledby="cut-up">
          {(["z", "y"] as const).map((axis) => (
            <button
              key={axis}
              type="button"
              class={up === axis ? "on" : ""}
              aria-pressed={up === axis}
              onClick={() => turnUp(axis)}
            >
              {axis}
            </button>
          ))}
        </span>
      </div>
    </div>
  );
}

function Row({ text, children }: { text: string; children: preact.ComponentChildren }) {
  return (
    <div class="frow">
      <span>{text}</span>
      {children}
    </div>
  );
}
