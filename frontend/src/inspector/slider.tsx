/** One setting: slider with a tick at the default, field, unit, and a reset when changed. */

import { useRef } from "preact/hooks";
import type { SettingChange, SettingSchema, SettingValue } from "../api/types";
import { setting } from "../geometry/format";
import { Icon } from "../ui/icon";
import { NumberField } from "../ui/number-field";

interface SettingProps {
  name: string;
  schema: SettingSchema;
  value: SettingValue | undefined;
  onChange: (value: SettingChange) => void;
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

/** A log scale that reaches 0 keeps its lowest end for it. */
const DECADES_TO_ZERO = 1e-4;

/** Share of the track [0, 1] from a value and back. */
function scaleOf(schema: SettingSchema, min: number, max: number): Scale {
  if (schema.scale === "log" && max > 0) {
    const low = min > 0 ? min : max * DECADES_TO_ZERO;
    const span = Math.log(max / low);
    return {
      to: (v) => (v <= low ? 0 : Math.log(v / low) / span),
      from: (s) => (s <= 0 ? min : low * Math.exp(s * span)),
    };
  }
  return { to: (v) => (v - min) / (max - min), from: (s) => min + s * (max - min) };
}

/** Three digits are as fine as anyone can slide. */
const rounded = (v: number) => Number(v.toPrecision(3));

const STEP = 0.01;
const LEAP = 0.1;

function SliderRow({ name, schema, value, onChange }: SettingProps) {
  const track = useRef<HTMLDivElement>(null);
  /** Without a default of its own, the robot or the plan decides: "auto". */
  const auto = typeof schema.default !== "number";
  const initial = typeof schema.default === "number" ? schema.default : Number.NaN;
  const min = schema.minimum ?? schema.exclusiveMinimum ?? 0;
  const max = schema.maximum ?? schema.exclusiveMaximum ?? 1;
  const now = typeof value === "number" ? value : initial;
  const changed = value !== undefined && value !== schema.default;
  const scale = scaleOf(schema, min, max);
  const whole = schema.type === "integer";
  const clamp = (v: number) => Math.min(max, Math.max(min, whole ? Math.round(v) : rounded(v)));
  const unset = Number.isNaN(now);
  const shareOf = (v: number) => (Number.isNaN(v) ? 0.5 : Math.min(1, Math.max(0, scale.to(v))));
  const share = shareOf(now);
  const base = shareOf(initial);
  /** A ratio is a number without a unit. */
  const unit = schema.unit && schema.unit !== "1" ? schema.unit : "";
  const words = unset ? "auto" : `${setting(now)} ${unit}`.trim();
  const label = schema.title ?? name;
  const percent = (s: number) => `${(s * 100).toFixed(2)}%`;

  const slideTo = (event: PointerEvent) => {
    const rect = track.current!.getBoundingClientRect();
    const at = (event.clientX - rect.left) / rect.width;
    // Within 2 % of the default's tick the slider rests on it.
    const onTick = !auto && Math.abs(at - base) < 0.02;
    onChange(onTick ? initial : clamp(scale.from(Math.min(1, Math.max(0, at)))));
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
        aria-valuenow={unset ? min : now}
        aria-valuetext={words}
        onPointerDown={(event) => {
          event.currentTarget.setPointerCapture(event.pointerId);
          slideTo(event);
        }}
        onPointerMove={(event) => event.buttons === 1 && slideTo(event)}
        onDblClick={() => onChange(null)}
        onKeyDown={onKeyDown}
      >
        {!auto && <u style={{ left: percent(base) }} />}
        {!unset && <s style={{ width: percent(share) }} />}
        <em class={unset ? "auto" : ""} style={{ left: percent(share) }} />
      </div>
      <NumberField
        label={`${label}, value`}
        value={now}
        min={min}
        max={max}
        format={(v) => (Number.isNaN(v) ? "auto" : setting(v))}
        onChange={(v) => onChange(whole ? Math.round(v) : v)}
      />
      <span class="un" title={unit}>
        {unit}
      </span>
      <Reset label={label} shown={changed} onReset={() => onChange(null)} />
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
