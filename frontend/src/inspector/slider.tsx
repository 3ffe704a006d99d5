/** One setting: slider with a tick at the default, field, unit, and a reset when changed. */

import { useRef, useState } from "preact/hooks";
import type { SettingChange, SettingSchema, SettingValue } from "../api/types";
import { setting } from "../geometry/format";
import { screenUnit, withUnit } from "../geometry/units";
import { Icon } from "../ui/icon";
import { NumberField } from "../ui/number-field";

export interface SettingProps {
  name: string;
  schema: SettingSchema;
  value: SettingValue | undefined;
  onChange: (value: SettingChange) => void;
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

export function SliderRow({ name, schema, value, onChange }: SettingProps) {
  const track = useRef<HTMLDivElement>(null);
  const [complaint, setComplaint] = useState("");
  /** Without a default of its own, the robot or the plan decides: "auto". */
  const auto = typeof schema.default !== "number";
  const initial = typeof schema.default === "number" ? schema.default : Number.NaN;
  const min = schema.minimum ?? schema.exclusiveMinimum ?? 0;
  const max = schema.maximum ?? schema.exclusiveMaximum ?? 1;
  const now = typeof value === "number" ? value : initial;
  const changed = value !== undefined && value !== schema.default;
  /** Between bounds that are far apart, most of what is set lies here. */
  const [low, high] = schema.slider ?? [min, max];
  const scale = scaleOf(schema, low, high);
  const whole = schema.type === "integer";
  const clamp = (v: number) => Math.min(high, Math.max(low, whole ? Math.round(v) : rounded(v)));
  const unset = Number.isNaN(now);
  const shareOf = (v: number) => (Number.isNaN(v) ? 0.5 : Math.min(1, Math.max(0, scale.to(v))));
  const share = shareOf(now);
  const base = shareOf(initial);
  const { unit, factor } = screenUnit(schema);
  const words = unset ? "auto" : withUnit(now, schema);
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
    const step = whole ? Math.max(Math.abs(change), 1 / (high - low)) * Math.sign(change) : change;
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
        value={now * factor}
        min={min * factor}
        max={max * factor}
        format={(v) => (Number.isNaN(v) ? "auto" : setting(v))}
        onChange={(v) => onChange(whole ? Math.round(v) : Number((v / factor).toPrecision(12)))}
        onComplaint={setComplaint}
      />
      <span class="un" title={unit}>
        {unit}
      </span>
      <Reset label={label} shown={changed} onReset={() => onChange(null)} />
      {complaint && (
        <p class="wrong" role="alert">
          {complaint} {unit}
        </p>
      )}
    </div>
  );
}

export function Reset({
  label,
  shown,
  onReset,
}: {
  label: string;
  shown: boolean;
  onReset: () => void;
}) {
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
