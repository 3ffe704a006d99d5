/** One setting: slider with a tick at the default, field, unit, and a reset when changed. */

import { useRef } from "preact/hooks";
import type { SettingSchema, SettingValue } from "../api/types";
import { setting } from "../geometry/format";
import { Icon } from "../ui/icon";
import { NumberField } from "../ui/number-field";

interface SettingProps {
  name: string;
  schema: SettingSchema;
  value: SettingValue | undefined;
  onChange: (value: SettingValue) => void;
}

export function SettingRow(props: SettingProps) {
  const { schema } = props;
  if (schema.enum) return <ChoiceRow {...props} />;
  if (schema.type === "boolean") return <SwitchRow {...props} />;
  return <SliderRow {...props} />;
}

interface Scale {
  to: (value: number) => number;
  from: (share: number) => number;
}

/** Share of the track [0, 1] from a value and back. */
function scaleOf(schema: SettingSchema, min: number, max: number): Scale {
  if (schema.scale === "log" && min > 0) {
    const span = Math.log(max / min);
    return { to: (v) => Math.log(v / min) / span, from: (s) => min * Math.exp(s * span) };
  }
  return { to: (v) => (v - min) / (max - min), from: (s) => min + s * (max - min) };
}

/** Three digits are as fine as anyone can slide. */
const rounded = (v: number) => Number(v.toPrecision(3));

const STEP = 0.01;
const LEAP = 0.1;

function SliderRow({ name, schema, value, onChange }: SettingProps) {
  const track = useRef<HTMLDivElement>(null);
  const initial = typeof schema.default === "number" ? schema.default : 0;
  const min = schema.minimum ?? schema.exclusiveMinimum ?? Math.min(0, initial);
  const max = schema.maximum ?? schema.exclusiveMaximum ?? Math.max(1, 2 * initial);
  const now = typeof value === "number" ? value : initial;
  const changed = value !== undefined && value !== schema.default;
  const scale = scaleOf(schema, min, max);
  const whole = schema.type === "integer";
  const clamp = (v: number) => Math.min(max, Math.max(min, whole ? Math.round(v) : rounded(v)));
  const share = Math.min(1, Math.max(0, scale.to(now)));
  const base = Math.min(1, Math.max(0, scale.to(initial)));
  const label = schema.title ?? name;
  const percent = (s: number) => `${(s * 100).toFixed(2)}%`;

  const slideTo = (event: PointerEvent) => {
    const rect = track.current!.getBoundingClientRect();
    const at = (event.clientX - rect.left) / rect.width;
    // Within 2 % of the default's tick the slider rests on it.
    onChange(
      Math.abs(at - base) < 0.02 ? initial : clamp(scale.from(Math.min(1, Math.max(0, at)))),
    );
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const by: Record<string, number> = {
      ArrowRight: STEP,
      ArrowUp: STEP,
      ArrowLeft: -STEP,
      ArrowDown: -STEP,
      PageUp: LEAP,
      PageDown: -LEAP,
      Home: -1,
      End: 1,
    };
    const change = by[event.key];
    if (change === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    const step = whole ? Math.max(Math.abs(change), 1 / (max - min)) * Math.sign(change) : change;
    onChange(clamp(scale.from(Math.min(1, Math.max(0, share + step)))));
  };

  return (
    <div class={changed ? "w changed" : "w"} title={schema.description}>
      <span class="wl">
        {label}
        {schema.symbol && <small>{schema.symbol}</small>}
      </span>
      <div
        ref={track}
        class="sl"
        role="slider"
        tabIndex={0}
        aria-label={label}
        aria-description={schema.description}
        aria-valuemin={min}
        aria-valuemax={max}
        aria-valuenow={now}
        aria-valuetext={`${setting(now)} ${schema.unit ?? ""}`}
        onPointerDown={(event) => {
          event.currentTarget.setPointerCapture(event.pointerId);
          slideTo(event);
        }}
        onPointerMove={(event) => event.buttons === 1 && slideTo(event)}
        onDblClick={() => onChange(initial)}
        onKeyDown={onKeyDown}
      >
        <u style={{ left: percent(base) }} />
        <s style={{ width: percent(share) }} />
        <em style={{ left: percent(share) }} />
      </div>
      <NumberField
        label={`${label}, value`}
        value={now}
        min={min}
        max={max}
        format={setting}
        onChange={(v) => onChange(whole ? Math.round(v) : v)}
      />
      <span class="un">{schema.unit === "1" ? "" : schema.unit}</span>
      <Reset label={label} shown={changed} onReset={() => onChange(initial)} />
    </div>
  );
}

function Reset({ label, shown, onReset }: { label: string; shown: boolean; onReset: () => void }) {
  if (!shown) return <span />;
  return (
    <button
      type="button"
      class="rs"
      aria-label={`Reset ${label}`}
      title={`Reset ${label}`}
      onClick={onReset}
    >
      <Icon name="reset" />
    </button>
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
      <Reset
        label={label}
        shown={value !== undefined}
        onReset={() => onChange(schema.default ?? "")}
      />
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
      <Reset
        label={label}
        shown={value !== undefined}
        onReset={() => onChange(schema.default ?? false)}
      />
    </div>
  );
}

export function Switch({
  label,
  on,
  onChange,
}: {
  label: string;
  on: boolean;
  onChange: (on: boolean) => void;
}) {
  return (
    <button
      type="button"
      class="sw"
      role="switch"
      aria-checked={on}
      aria-label={label}
      onClick={() => onChange(!on)}
    />
  );
}
