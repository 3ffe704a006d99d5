/** Pinned results over each other: CoM paths, plots over time or progress, figures in a table. */

import { useEffect, useState } from "preact/hooks";
import { Icon } from "../ui/icon";
import { saveFile } from "../ui/save-file";
import { Comparison, csv } from "./comparison";
import { Lines, type PinLine } from "./lines";
import { letter, styleOf } from "./pins";
import { Replay } from "./replay";
import { pinned, unpinAll } from "./store";
import { load, type Track, tracks } from "./tracks";

type Axis = "time" | "progress";
const AXES: [Axis, string, string][] = [
  ["time", "Time", "s"],
  ["progress", "Progress", "%"],
];
const PLOTS: ["pitchError" | "torque" | "comMargin", string, string][] = [
  ["pitchError", "Pitch error", "°"],
  ["torque", "Peak leg torque", "Nm"],
  ["comMargin", "CoM margin of the plan", "mm"],
];

export function Overlay({ back }: { back: () => void }) {
  const [axis, setAxis] = useState<Axis>("time");
  const shown = pinned.value;
  useEffect(() => load(shown), [shown]);
  return (
    <>
      <header class="ph">
        <button type="button" class="t back" onClick={back}>
          List
        </button>
        <h2>
          Overlay <small>{shown.length} pinned</small>
        </h2>
        {shown.length > 0 && (
          <>
            <button type="button" class="t" onClick={() => void unpinAll()}>
              Unpin all
            </button>
            <button
              type="button"
              class="t ico"
              aria-label="Download the table as CSV"
              title="Download the table as CSV"
              onClick={() => saveFile("stairwright-comparison.csv", csv(shown), "text/csv")}
            >
              <Icon name="download" />
            </button>
          </>
        )}
      </header>
      {shown.length === 0 ? (
        <p class="runs-none">
          Pin two runs or more with + to see their paths and plots over each other and their figures
          side by side.
        </p>
      ) : (
        // biome-ignore lint/a11y/noNoninteractiveTabindex: a scrolling region must take the focus
        <section class="runs-scroll" tabIndex={0} aria-label="Overlay and comparison">
          <div class="ovl-tools">
            <Legend count={shown.length} />
            <fieldset class="seg">
              <legend class="sr">Over</legend>
              {AXES.map(([name, title]) => (
                <button
                  key={name}
                  type="button"
                  aria-pressed={axis === name}
                  class={axis === name ? "on" : ""}
                  onClick={() => setAxis(name)}
                >
                  {title}
                </button>
              ))}
            </fieldset>
          </div>
          <Plots axis={axis} />
          <Comparison entries={shown} />
        </section>
      )}
    </>
  );
}

function Legend({ count }: { count: number }) {
  return (
    <ul class="ovl-legend">
      {Array.from({ length: count }, (_, i) => (
        <li key={letter(i)}>
          <svg viewBox="0 0 26 4" aria-hidden="true">
            <line
              x1="0"
              x2="26"
              y1="2"
              y2="2"
              style={{ stroke: styleOf(i).color, "stroke-dasharray": styleOf(i).dash || "none" }}
            />
          </svg>
          {letter(i)}
        </li>
      ))}
    </ul>
  );
}

function Plots({ axis }: { axis: Axis }) {
  const there = pinned.value.flatMap((entry, place) => {
    const track = tracks.value.get(entry.id);
    return track ? [{ place, track }] : [];
  });
  const waiting = pinned.value.some((entry) => tracks.value.get(entry.id) === null);
  const lines = (key: (typeof PLOTS)[number][0]): PinLine[] =>
    there.flatMap(({ place, track }: { place: number; track: Track }) => {
      const y = track[key];
      return y && y.length > 1 ? [{ place, x: track[axis], y }] : [];
    });
  const xUnit = AXES.find(([name]) => name === axis)![2];
  return (
    <>
      {waiting && <p class="runs-none">Reading the series…</p>}
      <Replay all={there} />
      {PLOTS.map(([key, title, unit]) => {
        const all = lines(key);
        return (
          all.length > 0 && <Lines key={key} title={title} unit={unit} xUnit={xUnit} lines={all} />
        );
      })}
    </>
  );
}
