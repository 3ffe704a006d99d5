/** Designs: which robot is best? The front of a search, and the robots that it is made of. */

import { useEffect } from "preact/hooks";
import { begin } from "./address";
import { Front } from "./front";
import { Best, InView, Searches } from "./panels";
import { SearchProgress } from "./progress";
import { RoomTabs } from "./room-tabs";
import { SearchForm } from "./search-form";
import { across, aimName, followSearches, search, searching } from "./state";
import { wordsOf } from "./words";

export function Designs() {
  useEffect(begin, []);
  useEffect(followSearches, []);
  return (
    <main class="map-room designs">
      <aside class="map-side" aria-label="Design searches">
        <header class="ph">
          <RoomTabs />
        </header>
        <div class="scroll">
          <SearchForm />
          <SearchProgress />
          <Searches />
        </div>
      </aside>
      <section class="map-middle" aria-label="Front">
        <header class="ph">
          <h2 title={subtitle()}>
            Design front <small>{subtitle()}</small>
          </h2>
          <AxisChoice />
        </header>
        <Body />
      </section>
      <aside class="map-side right" aria-label="Design">
        <div class="scroll">
          <InView />
          <Best />
        </div>
      </aside>
    </main>
  );
}

function subtitle(): string {
  const shown = search.value;
  if (!shown) return "";
  const { name, ask } = shown.design;
  const robot = typeof ask.robot === "string" ? ask.robot : ask.robot.name;
  const done = shown.complete
    ? ""
    : `, ${shown.candidates.length} of ${shown.design.designs} tried`;
  return `${name || robot}${done}`;
}

function Body() {
  const shown = search.value;
  if (!shown) {
    return (
      <div class="map-empty">
        <h3>Which robot would be better?</h3>
        <p>
          A design search varies lengths, masses and motors of a robot for up to three aims. Its
          front shows what one aim costs the other; a click opens the robot. Say what varies on the
          left, and press Run.
        </p>
      </div>
    );
  }
  if (!shown.candidates.some((each) => each.passed)) {
    return (
      <div class="map-empty">
        <h3>{nothingYet(shown.candidates.length)}</h3>
        <p>{shown.candidates[0]?.reason}</p>
      </div>
    );
  }
  return <Front />;
}

function nothingYet(tried: number): string {
  if (tried > 0) return "No design passes so far.";
  return searching.value ? "The first designs are being tried." : "No design was tried yet.";
}

/** With three aims: which two are drawn. */
function AxisChoice() {
  const aims = search.value?.design.aims ?? [];
  if (aims.length < 3) return null;
  const pick = (axis: 0 | 1, k: number) => {
    const [x, y] = across.peek();
    const other = axis === 0 ? y : x;
    // The two axes never show the same.
    const swapped = k === other ? (axis === 0 ? x : y) : other;
    across.value = axis === 0 ? [k, swapped] : [swapped, k];
  };
  return (
    <>
      {([0, 1] as const).map((axis) => (
        <select
          key={axis}
          aria-label={axis === 0 ? "Aim across" : "Aim up"}
          value={across.value[axis]}
          onChange={(event) => pick(axis, Number(event.currentTarget.value))}
        >
          {aims.map((aim, k) => (
            <option key={aimName(aim)} value={k}>
              {wordsOf(aimName(aim)).title}
            </option>
          ))}
        </select>
      ))}
    </>
  );
}
