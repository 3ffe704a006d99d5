/** What a setting is set by, as its schema asks: slider, choice, switch, or several numbers. */

import type { SettingSchema } from "../api/types";
import { setting } from "../geometry/format";
import { NumberField } from "../ui/number-field";
import { Switch } from "../ui/switch";
import { hasPlace, itemsOf, LoadRows, SpreadRows } from "./several-rows";
import { Reset, type SettingProps, SliderRow } from "./slider";

export function SettingRow(props: SettingProps) {
  const { schema } = props;
  const places = placesOf(schema);
  if (places) return <WheelsRow {...props} places={places} />;
  const item = itemsOf(schema);
  if (item) return <SpreadRows {...props} item={item} />;
  if (hasPlace(schema)) return <LoadRows {...props} />;
  if (schema.enum) return <ChoiceRow {...props} />;
  if (schema.type === "boolean") return <SwitchRow {...props} />;
  return <SliderRow {...props} />;
}

const WHEELS = ["FL", "FR", "RL", "RR"];

/** What each number of a list may be, where there is one for each wheel. */
function placesOf(schema: SettingSchema): SettingSchema[] | null {
  const places = schema.anyOf?.find((each) => each.prefixItems)?.prefixItems;
  return places?.length === WHEELS.length ? places : null;
}

function WheelsRow(props: SettingProps & { places: SettingSchema[] }) {
  const { name, schema, value, onChange, places } = props;
  const label = schema.title ?? name;
  const now = Array.isArray(value) ? (value as number[]) : null;
  const change = (k: number, next: number) =>
    // One that is set needs the others: they begin alike.
    onChange(now ? now.with(k, next) : places.map(() => next));
  return (
    <div class={now ? "w wheels changed" : "w wheels"} title={schema.description}>
      <span class="wl">{label}</span>
      <span class="each">
        {places.map((place, k) => (
          <span key={WHEELS[k]}>
            {WHEELS[k]}
            <NumberField
              label={`${label}, ${WHEELS[k]}`}
              value={now?.[k] ?? Number.NaN}
              min={place.exclusiveMinimum ?? place.minimum ?? 0}
              max={place.maximum ?? 1}
              format={(v) => (Number.isNaN(v) ? "auto" : setting(v))}
              onChange={(v) => change(k, v)}
            />
          </span>
        ))}
      </span>
      <Reset label={label} shown={now !== null} onReset={() => onChange(null)} />
    </div>
  );
}

function ChoiceRow({ name, schema, value, onChange }: SettingProps) {
  const label = schema.title ?? name;
  const now = value ?? schema.default;
  return (
    <div class={value === undefined ? "w" : "w changed"} title={schema.description}>
      <span class="wl">{label}</span>
      <select
        aria-label={label}
        value={String(now)}
        onChange={(event) => onChange(event.currentTarget.value)}
      >
        {schema.enum!.map((each) => (
          <option key={String(each)} value={String(each)}>
            {each}
          </option>
        ))}
      </select>
      <Reset label={label} shown={value !== undefined} onReset={() => onChange(null)} />
    </div>
  );
}

function SwitchRow({ name, schema, value, onChange }: SettingProps) {
  const label = schema.title ?? name;
  const now = Boolean(value ?? schema.default);
  return (
    <div class={value === undefined ? "w" : "w changed"} title={schema.description}>
      <span class="wl">{label}</span>
      <span class="push">
        <Switch label={label} on={now} onChange={onChange} />
      </span>
      <Reset label={label} shown={value !== undefined} onReset={() => onChange(null)} />
    </div>
  );
}
