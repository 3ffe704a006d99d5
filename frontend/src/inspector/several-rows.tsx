/** Settings of several numbers: one number or a list of them, and a load with its place. */

import { useEffect, useRef, useState } from "preact/hooks";
import type { SettingSchema, SettingValues } from "../api/types";
import { setting } from "../geometry/format";
import { screenUnit } from "../geometry/units";
import { NumberField, parseNumber } from "../ui/number-field";
import { Reset, type SettingProps, SliderRow } from "./slider";

/** What each number of a list may be, where a list may stand for the one number. */
export const itemsOf = (schema: SettingSchema): SettingSchema | null =>
  schema.oneOf?.find((each) => each.items)?.items ?? null;

/** Whether a place may be given beside the number. */
export const hasPlace = (schema: SettingSchema): boolean =>
  Boolean(schema.oneOf?.some((each) => each.properties?.place));

/** A spread that is drawn by chance, or known values, one for each in its order. */
export function SpreadRows(props: SettingProps & { item: SettingSchema }) {
  const { name, schema, value, onChange, item } = props;
  const label = schema.title ?? name;
  const listed = Array.isArray(value);
  const { unit, factor } = screenUnit(schema);
  const [complaint, setComplaint] = useState("");
  return (
    <>
      {!listed && <SliderRow {...props} schema={{ ...schema, title: `${label} ±` }} />}
      <div
        class={listed ? "w several changed" : "w several"}
        title="Known errors in the order along the course instead, between commas; beyond them there is none"
      >
        <span class="wl">{listed ? label : "or one by one"}</span>
        <NumbersField
          label={`${label}, one by one`}
          values={listed ? (value as readonly number[]).map((v) => v * factor) : []}
          min={(item.minimum ?? -Infinity) * factor}
          max={(item.maximum ?? Infinity) * factor}
          unit={unit}
          onComplaint={setComplaint}
          onChange={(values) =>
            onChange(
              values.length > 0 ? values.map((v) => Number((v / factor).toPrecision(12))) : null,
            )
          }
        />
        <span class="un">{unit}</span>
        <Reset label={label} shown={listed} onReset={() => onChange(null)} />
        {complaint && (
          <p class="wrong" role="alert">
            {complaint}
          </p>
        )}
      </div>
    </>
  );
}

interface NumbersProps {
  label: string;
  values: readonly number[];
  min: number;
  max: number;
  unit: string;
  onChange: (values: number[]) => void;
  onComplaint: (complaint: string) => void;
}

const parsed = (text: string) => text.split(/[\s,;]+/).flatMap((part) => (part ? [part] : []));

function NumbersField(props: NumbersProps) {
  const { label, values, min, max, unit, onChange, onComplaint } = props;
  const input = useRef<HTMLInputElement>(null);
  const [text, setText] = useState<string | null>(null);
  const written = values.map((v) => setting(v)).join(", ");
  const numbers = parsed(text ?? "").map(parseNumber);
  const valid = numbers.every((v) => v >= min && v <= max);
  const wrong = valid ? "" : `${setting(min)} to ${setting(max)} ${unit} each, with commas`;
  useEffect(() => onComplaint(wrong), [wrong]);
  useEffect(() => {
    if (document.activeElement !== input.current) setText(null);
  }, [written]);
  return (
    <input
      ref={input}
      type="text"
      class="num nums"
      aria-label={`${label}, ${unit}`}
      aria-invalid={!valid}
      placeholder="none"
      autocomplete="off"
      spellcheck={false}
      value={text ?? written}
      onInput={(event) => {
        const next = event.currentTarget.value;
        const now = parsed(next).map(parseNumber);
        setText(next);
        if (now.every((v) => v >= min && v <= max)) onChange(now);
      }}
      onKeyDown={(event) => event.stopPropagation()}
      onBlur={() => valid && setText(null)}
    />
  );
}

const AXES = ["x", "y", "z"] as const;
/** How far from the trunk's middle a load may lie [m]. */
const FAR = 2;

/** Its mass, and once there is some, its place in the trunk's frame. */
export function LoadRows(props: SettingProps) {
  const { name, schema, value, onChange } = props;
  const label = schema.title ?? name;
  const given = value && typeof value === "object" && !Array.isArray(value);
  const load = given ? (value as SettingValues) : null;
  const mass = load ? Number(load.mass) : value;
  const place = Array.isArray(load?.place) ? (load.place as readonly number[]) : null;
  const put = (k: number, at: number) =>
    // The first one that is set needs the others: they begin in the middle.
    onChange({ mass: Number(mass), place: (place ?? [0, 0, 0]).with(k, at) });
  return (
    <>
      <SliderRow
        {...props}
        value={mass}
        onChange={(next) => onChange(place && next ? { mass: next, place } : next)}
      />
      {Boolean(mass) && (
        <div
          class={place ? "w wheels changed" : "w wheels"}
          title="Its mass centre from the trunk’s middle: forward, left, up. On top of the trunk where nothing is set"
        >
          <span class="wl">{label}, place</span>
          <span class="each">
            {AXES.map((axis, k) => (
              <span key={axis}>
                {axis}
                <NumberField
                  label={`${label}, place ${axis} in mm`}
                  value={(place?.[k] ?? Number.NaN) * 1000}
                  min={-FAR * 1000}
                  max={FAR * 1000}
                  format={(v) => (Number.isNaN(v) ? "auto" : setting(v))}
                  onChange={(v) => put(k, v / 1000)}
                />
              </span>
            ))}
            mm
          </span>
          <Reset
            label={`${label}, place`}
            shown={place !== null}
            onReset={() => onChange(Number(mass))}
          />
        </div>
      )}
    </>
  );
}
