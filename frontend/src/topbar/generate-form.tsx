/** Stairs, ramps and flats from a few numbers; the service builds the profile. */

import { useState } from "preact/hooks";
import { fixed } from "../geometry/format";
import { CODES } from "../profile-editor/codes";
import { Icon } from "../ui/icon";
import { NumberField } from "../ui/number-field";
import { generate, generateError } from "./terrain-actions";

type Kind = "stair" | "ramp" | "flat";

interface Field {
  name: string;
  label: string;
  min: number;
  max: number;
  step: number;
  digits: number;
  initial: number;
}

const FIELDS: Record<Kind, Field[]> = {
  stair: [
    { name: "rise", label: "Rise, m", min: 0.01, max: 1, step: 0.005, digits: 3, initial: 0.178 },
    { name: "run", label: "Run, m", min: 0.05, max: 5, step: 0.005, digits: 3, initial: 0.279 },
    { name: "steps", label: "Steps", min: 1, max: 100, step: 1, digits: 0, initial: 4 },
  ],
  ramp: [
    { name: "height", label: "Height, m", min: 0.01, max: 5, step: 0.01, digits: 2, initial: 0.25 },
    { name: "angle", label: "Angle, °", min: 1, max: 60, step: 1, digits: 1, initial: 15 },
  ],
  flat: [{ name: "length", label: "Length, m", min: 1, max: 50, step: 0.1, digits: 1, initial: 3 }],
};

const initial = () =>
  Object.fromEntries(
    Object.values(FIELDS).flatMap((fields) => fields.map((f) => [f.name, f.initial])),
  );

/** REST speaks radians. */
function parameters(kind: Kind, values: Record<string, number>): Record<string, unknown> {
  const own = FIELDS[kind].map((f) => [
    f.name,
    f.name === "angle"
      ? (values[f.name]! * Math.PI) / 180
      : f.digits === 0
        ? Math.round(values[f.name]!)
        : values[f.name]!,
  ]);
  return { kind, ...Object.fromEntries(own) };
}

export function GenerateForm({ back, close }: { back: () => void; close: () => void }) {
  const [kind, setKind] = useState<Kind>("stair");
  const [values, setValues] = useState<Record<string, number>>(initial);
  const submit = async (event: Event) => {
    event.preventDefault();
    if (await generate(parameters(kind, values))) close();
  };
  return (
    <form class="generate" onSubmit={submit}>
      <div class="seg" role="radiogroup" aria-label="Kind">
        {(Object.keys(FIELDS) as Kind[]).map((each) => (
          <button
            key={each}
            type="button"
            role="radio"
            aria-checked={kind === each}
            class={kind === each ? "on" : ""}
            onClick={() => setKind(each)}
          >
            {each}
          </button>
        ))}
      </div>
      {FIELDS[kind].map((f) => (
        <div class="frow" key={f.name}>
          <span>{f.label}</span>
          <NumberField
            label={f.label}
            value={values[f.name]!}
            min={f.min}
            max={f.max}
            step={f.step}
            format={(v) => fixed(v, f.digits)}
            onChange={(v) => setValues({ ...values, [f.name]: v })}
          />
        </div>
      ))}
      {kind === "stair" && (
        <div class="chips">
          {CODES.map((each) => (
            <button
              key={each.name}
              type="button"
              title={each.note}
              onClick={() => setValues({ ...values, rise: each.rise, run: each.run })}
            >
              {each.name}
            </button>
          ))}
        </div>
      )}
      {generateError.value && (
        <p class="error" role="alert">
          {generateError.value}
        </p>
      )}
      <div class="acts end">
        <button type="button" class="btn" onClick={back}>
          Back
        </button>
        <button type="submit" class="btn pri">
          <Icon name="check" />
          Generate
        </button>
      </div>
    </form>
  );
}
