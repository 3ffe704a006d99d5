/** A row of the list: pin, picture, what differs, outcome, margins, figures, and what to do. */

import { useRef } from "preact/hooks";
import type { Entry, Summary } from "../api/stored";
import { fixed, maybe } from "../geometry/format";
import { CLASS_NAMES, MARGINS, marginClass, stated } from "../profile-editor/margins";
import { OUTCOMES, verdict } from "../results/figures";
import { Icon } from "../ui/icon";
import { Menu } from "../ui/menu";
import { chips } from "./chips";
import { openInPlan } from "./open";
import { letter, styleOf } from "./pins";
import { change, pinned, remove, title } from "./store";
import { Thumbnail } from "./thumbnail";

const SHOWN_CHIPS = 3;

export function Row({ entry }: { entry: Entry }) {
  const { summary } = entry;
  const called = title(entry);
  const bad = failed(entry);
  return (
    <li class={entry.pinned ? "run on" : "run"} data-id={entry.id}>
      <Pin entry={entry} />
      <button
        type="button"
        class="run-open"
        title={entry.note || `Open ${called} in Plan`}
        onClick={() => void openInPlan(entry)}
      >
        <Thumbnail summary={summary} bad={bad} />
        <span class="run-name">
          <b>{called}</b>
          <small>
            {entry.name ? `${summary.terrain}, ` : ""}
            {summary.robot}, {when(entry.created)}
          </small>
          {entry.note && <small class="run-note">{entry.note}</small>}
        </span>
      </button>
      <Chips entry={entry} />
      <span class={`run-out ${severity(entry)}`}>
        <Icon name={bad ? "warning" : "check"} />
        <b>{outcome(entry)}</b>
      </span>
      <MarginCells entry={entry} />
      <span class="run-num">{summary.duration ? `${fixed(summary.duration, 1)} s` : "–"}</span>
      <Transport summary={summary} />
      <RowMenu entry={entry} />
    </li>
  );
}

/** What driving took, of a rollout as it was, else as it is planned. */
function Transport({ summary: s }: { summary: Summary }) {
  const planned = s.metrics === undefined;
  const energy = planned ? s.planned_energy : s.metrics?.energy;
  const cost = planned ? s.planned_cost_of_transport : s.cost_of_transport;
  const whose = planned ? "Planned energy" : "Energy";
  return (
    <span
      class="run-num cot"
      title={`${whose}, and cost of transport: energy per unit of weight and distance, without unit`}
    >
      {maybe(energy, 0, " J")}
      <small>{maybe(cost, 2)}</small>
    </span>
  );
}

const severity = (entry: Entry) =>
  entry.summary.outcome ? verdict(entry.summary.outcome) : failed(entry) ? "bad" : "";

export const failed = ({ summary: s }: Entry) =>
  s.outcome
    ? s.outcome !== "success"
    : s.count === undefined
      ? s.status !== "feasible"
      : s.successes !== s.count;

export function outcome({ summary: s }: Entry): string {
  if (s.count !== undefined) return `${s.successes} / ${s.count}`;
  if (s.outcome) return OUTCOMES[s.outcome];
  return s.status === "feasible" ? "Feasible" : "Infeasible";
}

/** Today the time, before that the day. */
function when(created: number): string {
  const date = new Date(created * 1000);
  const today = date.toDateString() === new Date().toDateString();
  return today
    ? date.toLocaleTimeString("en-GB", { hour: "2-digit", minute: "2-digit" })
    : date.toLocaleDateString("en-GB", { day: "numeric", month: "short", year: "numeric" });
}

function Pin({ entry }: { entry: Entry }) {
  const place = pinned.value.findIndex((each) => each.id === entry.id);
  const label = entry.pinned ? `Unpin ${title(entry)}` : `Pin ${title(entry)} to compare it`;
  return (
    <button
      type="button"
      class="run-pin"
      aria-label={label}
      aria-pressed={entry.pinned}
      title={label}
      style={place >= 0 ? { "--pin": styleOf(place).color } : {}}
      onClick={() => void change(entry, { pinned: !entry.pinned })}
    >
      {place >= 0 ? letter(place) : <Icon name="plus" />}
    </button>
  );
}

function Chips({ entry }: { entry: Entry }) {
  const all = chips(entry);
  const rest = all.length - SHOWN_CHIPS;
  return (
    <span class="run-chips" title={all.join(", ")}>
      {all.slice(0, SHOWN_CHIPS).map((chip) => (
        <i key={chip}>{chip}</i>
      ))}
      {rest > 0 && <small>and {rest} more</small>}
    </span>
  );
}

function MarginCells({ entry }: { entry: Entry }) {
  const { margins } = entry.summary;
  if (!margins) return <span class="run-margins">–</span>;
  const words = MARGINS.map(
    (kind) => `${kind.title} ${CLASS_NAMES[marginClass(kind, margins[kind.name])]}`,
  );
  return (
    <span class="run-margins" title={`Least margins of the plan: ${words.join(", ")}`}>
      <span class="cells" role="img" aria-label={words.join(", ")}>
        {MARGINS.map((kind) => (
          <i key={kind.name} class={`m${marginClass(kind, margins[kind.name])}`} />
        ))}
      </span>
      <small>
        {fixed(stated(margins.clearance) * 1000, 0)}, {fixed(stated(margins.com) * 1000, 0)} mm
      </small>
    </span>
  );
}

function RowMenu({ entry }: { entry: Entry }) {
  return (
    <Menu
      label={`Name, note or delete ${title(entry)}`}
      button={<Icon name="more" />}
      buttonClass="t ico"
      panelClass="run-menu"
      kind="dialog"
      align="right"
    >
      {(close) => <Form entry={entry} close={close} />}
    </Menu>
  );
}

function Form({ entry, close }: { entry: Entry; close: () => void }) {
  const name = useRef<HTMLInputElement>(null);
  const note = useRef<HTMLTextAreaElement>(null);
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        const said = { name: name.current!.value.trim(), note: note.current!.value.trim() };
        void change(entry, said);
        close();
      }}
    >
      <label>
        Name
        <input ref={name} defaultValue={entry.name} maxLength={100} />
      </label>
      <label>
        Note
        <textarea ref={note} defaultValue={entry.note} maxLength={2000} rows={3} />
      </label>
      <div class="acts">
        <button type="submit" class="btn pri">
          Save
        </button>
        <button
          type="button"
          class="btn"
          onClick={() => {
            close();
            remove(entry);
          }}
        >
          <Icon name="trash" />
          Delete
        </button>
      </div>
    </form>
  );
}
