/** The sheet of keys that "?" opens. */

import { signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";

export const shortcutsOpen = signal(false);

const SHEET: [string, [string, string][]][] = [
  [
    "Page",
    [
      ["1 to 4", "workspaces"],
      ["Ctrl Z, Ctrl Shift Z", "undo, redo"],
      ["Ctrl S", "save the terrain"],
      ["?", "these keys"],
    ],
  ],
  [
    "Layout",
    [
      ["X", "swap profile and scene"],
      ["M", "maximise, or show both again"],
      ["L", "legend of the scene"],
      ["I", "open or close the inspector"],
      ["Escape", "cancel, show both, select none"],
    ],
  ],
  [
    "Profile",
    [
      ["V S R F P", "select, stair, ramp, flat, free"],
      ["Page Up, Page Down", "to the corner before, after"],
      ["Arrows", "move by 1 cm; Shift 10 cm, Alt 1 mm"],
      ["Insert, Delete", "add or delete a corner"],
      ["Enter", "type its x and z"],
      ["Space and drag", "move the view"],
    ],
  ],
  [
    "Time",
    [
      ["Space", "play or pause"],
      ["Arrows on the timeline", "0.1 s; Page Up and Down 1 s"],
      ["Home, End", "start, end"],
    ],
  ],
];

export function Shortcuts() {
  return shortcutsOpen.value ? <Sheet /> : null;
}

function Sheet() {
  const dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => dialog.current?.showModal(), []);
  const close = () => {
    shortcutsOpen.value = false;
  };
  return (
    <dialog ref={dialog} class="tag keys-sheet" aria-labelledby="keys-title" onClose={close}>
      <h2 id="keys-title">Keys</h2>
      <div>
        {SHEET.map(([title, rows]) => (
          <section key={title}>
            <h3>{title}</h3>
            <dl>
              {rows.map(([key, does]) => (
                <div key={key}>
                  <dt>{key}</dt>
                  <dd>{does}</dd>
                </div>
              ))}
            </dl>
          </section>
        ))}
      </div>
      <form method="dialog" class="acts end">
        <button type="submit" class="btn pri">
          Close
        </button>
      </form>
    </dialog>
  );
}
