/** Beside the drawing: the searches there are, and the design in view with the best ones. */

import { fixed } from "../geometry/format";
import { Icon } from "../ui/icon";
import { IconButton } from "../ui/icon-button";
import { numberOf } from "./numbers";
import { openDesign } from "./open-robot";
import {
  aimName,
  front,
  inView,
  openFile,
  openSearch,
  pointAt,
  remove,
  search,
  summaries,
  title,
  trouble,
} from "./state";
import { withUnit, wordsOf } from "./words";

/** What the list says of a search beside its numbers. */
const STATES: Record<string, string> = {
  queued: ", waiting",
  running: ", at work",
  cancelled: ", paused",
  failed: ", stopped",
};

export function Searches() {
  return (
    <section>
      <h3>Design searches</h3>
      {summaries.value.length === 0 && <p class="sub">None in this service yet.</p>}
      <ul class="searches">
        {summaries.value.map((each) => (
          <li key={each.id}>
            <button
              type="button"
              aria-pressed={search.value?.id === each.id}
              onClick={() => void openSearch(each.id)}
            >
              <b>{title(each)}</b>
              <small>
                {each.complete ? "" : `${each.tried} of `}
                {each.designs} designs, {each.best} on the front
                {STATES[each.state ?? ""]}
              </small>
            </button>
            <IconButton
              icon="trash"
              label={`Delete ${title(each)}`}
              action={() => remove(each)}
              off={false}
            />
          </li>
        ))}
      </ul>
      <label class="btn file">
        <Icon name="upload" />
        Open a result
        <input
          type="file"
          accept=".json"
          class="sr"
          onChange={(event) => {
            const file = event.currentTarget.files?.[0];
            if (file) void openFile(file);
            event.currentTarget.value = "";
          }}
        />
      </label>
      {trouble.value && (
        <p class="error" role="alert">
          {trouble.value}
        </p>
      )}
      <p class="sub">
        <code>stairwright design FILE</code> searches from the command line, for anything that a
        study can ask. Here its front grows while it runs.
      </p>
    </section>
  );
}

export function InView() {
  const shown = search.value;
  const number = inView.value;
  const candidate = number === null ? null : shown?.candidates[number];
  if (!shown || !candidate || number === null) return null;
  const robot = shown.design.ask.robot;
  return (
    <section class="kept">
      <h2>Design {number + 1}</h2>
      <dl>
        {Object.entries(candidate.aims).map(([name, value]) => (
          <div key={name}>
            <dt>{wordsOf(name).title}</dt>
            <dd>{value === null ? "–" : withUnit(name, value)}</dd>
          </div>
        ))}
        {shown.design.vary
          .filter(({ name }) => !(name in candidate.aims))
          .map(({ name }) => {
            const before = numberOf(robot, name);
            return (
              <div key={name}>
                <dt>{wordsOf(name).title}</dt>
                <dd>
                  {withUnit(name, candidate.values[name]!)}
                  {before !== null && <small> was {wordsOf(name).show(before)}</small>}
                </dd>
              </div>
            );
          })}
      </dl>
      {candidate.best ? (
        <button type="button" class="btn pri" onClick={() => openDesign(number)}>
          Open this robot
        </button>
      ) : (
        <p class="sub">Others are as good in every aim, and better in one.</p>
      )}
    </section>
  );
}

/** The front in numbers, for reading and for the keyboard. */
export function Best() {
  const shown = search.value;
  if (!shown?.candidates.length) return null;
  const names = shown.design.aims.map(aimName);
  const passed = shown.candidates.filter((each) => each.passed).length;
  return (
    <section>
      <h3>{front.value.length === 1 ? "The best one" : `The ${front.value.length} best`}</h3>
      <table class="codes">
        <thead>
          <tr>
            <th scope="col">no.</th>
            {names.map((name) => (
              <th scope="col" key={name}>
                {wordsOf(name).title}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {front.value.map((number) => (
            <tr key={number} class={inView.value === number ? "seen" : ""}>
              <th scope="row">
                <button type="button" class="link" onClick={() => pointAt(number)}>
                  {number + 1}
                </button>
              </th>
              {names.map((name) => (
                <td key={name}>{withUnit(name, shown.candidates[number]!.aims[name] ?? NaN)}</td>
              ))}
            </tr>
          ))}
        </tbody>
      </table>
      <p class="sub">
        {shown.candidates.length} tried, {passed} pass. <Failures />
      </p>
    </section>
  );
}

const SHOWN = 3;

/** Why the others do not pass, the most frequent first. */
function Failures() {
  const counts = new Map<string, number>();
  for (const each of search.value?.candidates ?? []) {
    if (each.passed) continue;
    // Sentences differ in their numbers; what comes before the first one is the reason.
    const first = each.reason
      .split(/[\d:;,(]/)[0]!
      .replace(/ at x =\s*$/, "")
      .trim();
    const why = first || "no reason given";
    counts.set(why, (counts.get(why) ?? 0) + 1);
  }
  if (counts.size === 0) return null;
  const most = [...counts].sort((a, b) => b[1] - a[1]).slice(0, SHOWN);
  return <>The others: {most.map(([why, n]) => `${why} (${fixed(n, 0)})`).join("; ")}.</>;
}
