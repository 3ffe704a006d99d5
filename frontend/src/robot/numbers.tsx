/** Every number of the robot, with its unit and where it comes from. */

import { degrees, fixed } from "../geometry/format";
import { robotDocument } from "../state/setup";
import { Icon } from "../ui/icon";
import { NumberField } from "../ui/number-field";
import { changed, finish, resetQuantity, selected, set } from "./edit";
import { type Marked, markOf, TITLES } from "./marks";
import { GROUPS, type Group, QUANTITIES, type Quantity, totalMass } from "./quantities";

export function Numbers() {
  const file = robotDocument.value;
  if (!file) return null;
  return (
    <aside class="numbers" aria-label="Numbers">
      <header class="hd">
        <h2>Numbers</h2>
        {(["source", "assumed", "edited"] as const).map((mark) => (
          <span key={mark} class="legend">
            <i class={`mark ${mark}`} />
            {TITLES[mark]}
          </span>
        ))}
      </header>
      {/* biome-ignore lint/a11y/noNoninteractiveTabindex: a region that scrolls must be reachable by key */}
      <section class="rows" tabIndex={0} aria-label="Table of numbers">
        {GROUPS.map((group) => (
          <Rows key={group} group={group} />
        ))}
        <Texts />
      </section>
    </aside>
  );
}

function Rows({ group }: { group: Group }) {
  const file = robotDocument.value!;
  const rows = QUANTITIES.filter((q) => q.group === group && q.read(file) !== null);
  return (
    <>
      <h3>{group}</h3>
      {group === "Joint ranges"
        ? rows
            .filter((_, i) => i % 2 === 0)
            .map((low, i) => <RangeRow key={low.id} low={low} high={rows[2 * i + 1]!} />)
        : rows.map((q) => <Row key={q.id} q={q} />)}
      {group === "Masses" && (
        <div class="number">
          <span>Total</span>
          <output>{fixed(totalMass(file), 2)}</output>
          <span class="unit">kg</span>
          <span class="note">both sides</span>
        </div>
      )}
    </>
  );
}

function Field({ q }: { q: Quantity }) {
  const file = robotDocument.value!;
  const value = q.read(file) ?? 0;
  const format = (v: number) => fixed(v, q.digits);
  return (
    <span
      data-quantity={q.id}
      class={selected.value === q.id ? "sel" : undefined}
      onFocusIn={() => {
        selected.value = q.id;
      }}
    >
      <NumberField
        label={`${q.label}, ${q.unit}`}
        value={value * q.factor}
        min={q.min * q.factor}
        max={q.max * q.factor}
        step={q.step * q.factor}
        format={format}
        onChange={(v) => set(q.id, v / q.factor)}
        onDone={finish}
      />
    </span>
  );
}

const shows = (q: Quantity) => (value: number) => fixed(value * q.factor, q.digits);

function Row({ q }: { q: Quantity }) {
  return (
    <div class="number" data-mark={markOf(q, shows(q)).mark}>
      <span>{q.label}</span>
      <Field q={q} />
      <span class="unit">{q.unit}</span>
      <Note of={[q]} marked={markOf(q, shows(q))} />
    </div>
  );
}

function RangeRow({ low, high }: { low: Quantity; high: Quantity }) {
  const marks = [markOf(low, shows(low)), markOf(high, shows(high))];
  const marked = marks.find((m) => m.mark === "edited") ?? marks[0]!;
  return (
    <div class="number range-row" data-mark={marked.mark}>
      <span>{low.label.replace(", lower", "")}</span>
      <span class="pair">
        <Field q={low} />
        <span aria-hidden="true">…</span>
        <Field q={high} />
      </span>
      <span class="unit">°</span>
      <Note of={[low, high]} marked={marked} />
    </div>
  );
}

function Note({ of, marked }: { of: Quantity[]; marked: Marked }) {
  const edited = of.filter((q) => changed.value.has(q.id));
  return (
    <span class="note" title={marked.text}>
      <i class={`mark ${marked.mark}`} />
      <span class="sr">{TITLES[marked.mark]}</span>
      {marked.note && <b>{marked.note}</b>}
      {edited.length > 0 && (
        <button
          type="button"
          class="t ico back"
          aria-label={`Reset ${of[0]!.label}`}
          title="Reset"
          onClick={() => {
            for (const q of edited) resetQuantity(q.id);
          }}
        >
          <Icon name="reset" />
        </button>
      )}
    </span>
  );
}

/** Where the numbers are from, and what nobody publishes, in the file's own words. */
function Texts() {
  const file = robotDocument.value!;
  const assumed = file.assumed ?? [];
  const held = Object.entries(file.held_joints ?? {});
  return (
    <div class="texts">
      {file.source && (
        <>
          <h3>Source</h3>
          <p>{file.source}</p>
        </>
      )}
      {assumed.length > 0 && (
        <>
          <h3>Assumed</h3>
          <ul>
            {assumed.map((text) => (
              <li key={text}>{text}</li>
            ))}
          </ul>
        </>
      )}
      {file.abduction ? (
        <p>Abduction joints locked at {fixed(degrees(file.abduction), 1)}°.</p>
      ) : null}
      {held.length > 0 && (
        <p>Rigid [rad]: {held.map(([joint, at]) => `${joint} ${fixed(at, 2)}`).join(", ")}.</p>
      )}
    </div>
  );
}
