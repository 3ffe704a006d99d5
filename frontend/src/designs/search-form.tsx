/** A new search: what to climb, which numbers of the robot vary between what, up to three aims. */

import { fixed } from "../geometry/format";
import { Segments } from "../inspector/segments";
import { manner } from "../map/form";
import { drawing } from "../state/drawing";
import { robotName } from "../state/setup";
import { CountField } from "../ui/count-field";
import { NumberField } from "../ui/number-field";
import type { AimChoice } from "./aims";
import {
  aims,
  borderRange,
  change,
  choices,
  chooseAim,
  form,
  ground,
  MOST_AIMS,
  MOST_DESIGNS,
  type Range,
  type Row,
  rows,
  setBorder,
  setRange,
  setVaries,
} from "./form";

export function SearchForm() {
  const chosen = aims.value;
  const friction = chosen.some((each) => each.aim.minimise === "friction");
  return (
    <>
      <section class="search-form">
        <h3>New search</h3>
        <p class="sub">
          {robotName.value} on {ground()}
          {friction ? "" : `, μ ${fixed(drawing.value.friction, 2)}`}
          {manner()}
        </p>
        <Segments
          small
          label="What a design has to pass"
          options={[
            ["plan", "Plan"],
            ["rollout", "Rollout"],
            ["trials", "Trials"],
          ]}
          value={form.value.compute}
          onChoose={(compute) => change({ compute })}
        />
        {form.value.compute === "trials" && (
          <Count
            label="Number of trials"
            before="All of"
            after="trials"
            value={form.value.trials}
            most={1000}
            set={(trials) => change({ trials })}
          />
        )}
      </section>
      <section class="search-form">
        <h3>Varies</h3>
        {rows.value.map((row) => (
          <Vary key={row.name} row={row} />
        ))}
      </section>
      <section class="search-form">
        <h3>Aims</h3>
        {chosen.map((choice, place) => (
          <AimFields key={choice.key} place={place} choice={choice} />
        ))}
        {chosen.length < MOST_AIMS && <AimFields place={chosen.length} choice={null} />}
        <Count
          label="Number of designs"
          before="Try"
          after="designs"
          value={form.value.designs}
          most={MOST_DESIGNS}
          set={(designs) => change({ designs })}
        />
      </section>
    </>
  );
}

function Vary({ row }: { row: Row }) {
  const { name, title, unit, digits, value, on, range } = row;
  return (
    <div class="vary">
      <label class="chk">
        <input
          type="checkbox"
          checked={on}
          onChange={(event) => setVaries(name, event.currentTarget.checked)}
        />
        {title}
        <small>
          {fixed(value, digits)} {unit}
        </small>
      </label>
      {on && (
        <Ends
          title={title}
          unit={unit}
          digits={digits}
          range={range}
          set={(next) => setRange(name, next)}
        />
      )}
    </div>
  );
}

function AimFields({ place, choice }: { place: number; choice: AimChoice | null }) {
  const taken = new Set(aims.value.map((each) => each.key));
  const free = choices.value.filter((each) => each.key === choice?.key || !taken.has(each.key));
  const range = choice && borderRange(choice);
  return (
    <div class="axis">
      <div class="pick">
        <label for={`aim-${place}`}>{place + 1}</label>
        <select
          id={`aim-${place}`}
          aria-label={`Aim ${place + 1}`}
          value={choice?.key ?? ""}
          onChange={(event) => chooseAim(place, event.currentTarget.value || null)}
        >
          {(place > 0 || !choice) && <option value="">none</option>}
          {free.map((each) => (
            <option key={each.key} value={each.key}>
              {each.title}
            </option>
          ))}
        </select>
      </div>
      {choice?.border && range && (
        <Ends
          title={choice.title}
          unit={choice.border.unit}
          digits={choice.border.digits}
          range={range}
          set={(next) => setBorder(choice, next)}
        />
      )}
    </div>
  );
}

interface EndsProps {
  title: string;
  unit: string;
  digits: number;
  range: Range;
  set: (range: Range) => void;
}

/** From, to, and of a border how finely. */
function Ends({ title, unit, digits, range, set }: EndsProps) {
  const field = (part: keyof Range, label: string, min: number) => (
    <NumberField
      label={`${title} ${label}`}
      value={range[part]!}
      min={min}
      max={1e6}
      step={10 ** -Math.min(2, digits)}
      format={(v) => fixed(v, digits)}
      onChange={(next) => set({ ...range, [part]: next })}
    />
  );
  return (
    <div class="range">
      {field("from", "from", 0)}
      <span>to</span>
      {field("to", "to", 0)}
      <span class="unit">{unit}</span>
      {range.tolerance !== undefined && (
        <span class="within">within {field("tolerance", "within", 10 ** -digits)}</span>
      )}
    </div>
  );
}

interface CountProps {
  label: string;
  before: string;
  after: string;
  value: number;
  most: number;
  set: (value: number) => void;
}

function Count({ label, before, after, value, most, set }: CountProps) {
  return (
    <div class="range count">
      <span>{before}</span>
      <CountField label={label} value={value} max={most} onChange={set} />
      <span>{after}</span>
    </div>
  );
}
