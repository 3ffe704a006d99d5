/** The workspace Runs: what was planned, rolled out and tried, and how some of it compares. */

import { useEffect, useState } from "preact/hooks";
import { Icon } from "../ui/icon";
import { Overlay } from "./overlay";
import { Row } from "./row";
import {
  entries,
  type Filter,
  filter,
  hasMore,
  loading,
  more,
  narrow,
  pinned,
  search,
  startListing,
  total,
  trouble,
} from "./store";

const FILTERS: [Filter, string][] = [
  ["all", "All"],
  ["plans", "Plans"],
  ["rollouts", "Rollouts"],
  ["trials", "Trials"],
];
const TYPING = 250;

export function Runs() {
  const [comparing, setComparing] = useState(false);
  useEffect(startListing, []);
  return (
    <main class="runs" data-comparing={comparing ? "" : undefined}>
      <section class="runs-list" aria-label="Runs">
        <header class="ph">
          <h2>
            Runs <small>{total.value} kept by the service</small>
          </h2>
          <button type="button" class="t compare" onClick={() => setComparing(true)}>
            Compare {pinned.value.length}
          </button>
        </header>
        <Tools />
        <List />
      </section>
      <section class="runs-overlay" aria-label="Overlay">
        <Overlay back={() => setComparing(false)} />
      </section>
    </main>
  );
}

function Tools() {
  const [text, setText] = useState(search.peek());
  useEffect(() => {
    const timer = setTimeout(() => text !== search.peek() && narrow({ search: text }), TYPING);
    return () => clearTimeout(timer);
  }, [text]);
  return (
    <div class="runs-tools">
      <fieldset class="seg">
        <legend class="sr">Show</legend>
        {FILTERS.map(([name, title]) => (
          <button
            key={name}
            type="button"
            aria-pressed={filter.value === name}
            class={filter.value === name ? "on" : ""}
            onClick={() => narrow({ filter: name })}
          >
            {title}
          </button>
        ))}
      </fieldset>
      <input
        type="search"
        aria-label="Search names, notes, terrains, robots and outcomes"
        placeholder="Search"
        value={text}
        onInput={(event) => setText(event.currentTarget.value)}
        onKeyDown={(event) => event.stopPropagation()}
      />
    </div>
  );
}

function List() {
  if (trouble.value) {
    return (
      <p class="runs-none" role="alert">
        The list could not be read. {trouble.value}
      </p>
    );
  }
  if (entries.value.length === 0) {
    return <p class="runs-none">{loading.value ? "Reading…" : nothing()}</p>;
  }
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: a scrolling region must take the focus
    <div class="runs-scroll" tabIndex={0} role="region" aria-label="List of runs">
      <div class="run-head" aria-hidden="true">
        <span />
        <span>terrain, robot</span>
        <span>settings</span>
        <span>outcome</span>
        <span>clearance, CoM</span>
        <span class="run-num">time</span>
        <span class="run-num cot">energy, CoT</span>
        <span />
      </div>
      <ul>
        {entries.value.map((entry) => (
          <Row key={entry.id} entry={entry} />
        ))}
      </ul>
      {hasMore.value && (
        <button type="button" class="btn more" disabled={loading.value} onClick={more}>
          <Icon name="down" />
          Show more
        </button>
      )}
    </div>
  );
}

function nothing(): string {
  if (search.value) return `Nothing has “${search.value}” in its name, note, terrain or outcome.`;
  return filter.value === "trials"
    ? "No trials yet. Run some from the inspector in Plan."
    : "Nothing yet. Plan and run something, and it is kept here.";
}
