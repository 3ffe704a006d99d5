/** What the map is asked for: axes, friction, colour, codes; and how far it is. */

import { RoomTabs } from "../designs/room-tabs";
import { fixed } from "../geometry/format";
import { edited } from "../robot/edit";
import { drawing } from "../state/drawing";
import { allRobots, robotName } from "../state/setup";
import { CountField } from "../ui/count-field";
import { Icon } from "../ui/icon";
import { Menu, MenuItem } from "../ui/menu";
import { NumberField } from "../ui/number-field";
import { CODES } from "./codes";
import {
  asksSteps,
  change,
  chooseAxis,
  type Friction,
  form,
  ground,
  hasFriction,
  manner,
  PRESETS,
  type Range,
} from "./form";
import { Progress } from "./progress";
import { AXES, axisKind, QUANTITIES } from "./quantities";
import { quantity } from "./state";
import { options, showsCodes, toggle, toggleCode } from "./view";

export function StudyPanel() {
  return (
    <aside class="map-side" aria-label="Study">
      <header class="ph">
        <RoomTabs />
        <Presets />
      </header>
      <div class="scroll">
        <section>
          <h3>Axes</h3>
          <AxisFields which="x" range={form.value.x} />
          <AxisFields which="y" range={form.value.y} />
          <FrictionChoice />
          <Second />
          <p class="sub">
            {robotName.value}, {ground(form.value)}
            {manner()}
          </p>
        </section>
        <Progress />
        <section>
          <h3>Colour</h3>
          <select
            aria-label="Colour by"
            value={quantity.value}
            onChange={(event) => {
              quantity.value = event.currentTarget.value;
            }}
          >
            {QUANTITIES.map((kind) => (
              <option key={kind.name} value={kind.name}>
                {kind.title}, {kind.unit}
              </option>
            ))}
          </select>
          <Check
            label="Contour lines"
            on={options.value.contours}
            flip={() => toggle("contours")}
          />
          <Check label="Reasons" on={options.value.reasons} flip={() => toggle("reasons")} />
          <Check
            label="Values in cells"
            on={options.value.numbers}
            flip={() => toggle("numbers")}
          />
        </section>
        {showsCodes.value && (
          <section>
            <h3>Building codes</h3>
            {CODES.map((code) => (
              <Check
                key={code.name}
                label={code.name}
                title={code.note}
                on={options.value.codes.has(code.name)}
                flip={() => toggleCode(code.name)}
                dash={code.dash}
              />
            ))}
          </section>
        )}
      </div>
    </aside>
  );
}

function Presets() {
  const button = (
    <>
      Presets
      <Icon name="down" />
    </>
  );
  return (
    <Menu label="Presets" named button={button} buttonClass="t" align="right">
      {(close) =>
        PRESETS.map((preset) => (
          <MenuItem
            key={preset.title}
            onChoose={() => {
              form.value = preset.form;
              close();
            }}
          >
            <span class="two">
              {preset.title}
              <small>{preset.note}</small>
            </span>
          </MenuItem>
        ))
      }
    </Menu>
  );
}

function AxisFields({ which, range }: { which: "x" | "y"; range: Range }) {
  const kind = axisKind(range.name);
  const set = (part: Partial<Range>) => change({ [which]: { ...range, ...part } });
  const [least, most] = kind.limits;
  const end = (part: "from" | "to") => (
    <NumberField
      label={`${kind.title} ${part}`}
      value={range[part]}
      min={least}
      max={most}
      step={10 ** -Math.min(2, kind.digits)}
      format={(v) => fixed(v, kind.digits)}
      onChange={(value) => set({ [part]: value })}
    />
  );
  return (
    <div class="axis">
      <div class="pick">
        <label for={`axis-${which}`}>{which}</label>
        <select
          id={`axis-${which}`}
          value={range.name}
          onChange={(event) => chooseAxis(which, event.currentTarget.value)}
        >
          {AXES.map((each) => (
            <option key={each.name} value={each.name}>
              {each.title}
            </option>
          ))}
        </select>
      </div>
      <div class="range">
        {end("from")}
        <span>to</span>
        {end("to")}
        <span class="unit">{kind.unit}</span>
        <CountField
          label={`${kind.title}, number of values`}
          value={range.count}
          min={2}
          max={200}
          class="few"
          onChange={(count) => set({ count })}
        />
        <span>values</span>
      </div>
    </div>
  );
}

function FrictionChoice() {
  const now = form.value;
  if (hasFriction(now)) return asksSteps(now) ? <Steps /> : null;
  return (
    <>
      <div class="pick">
        <label for="map-friction">μ</label>
        <select
          id="map-friction"
          value={now.friction}
          onChange={(event) => change({ friction: event.currentTarget.value as Friction })}
        >
          <option value="page">at {fixed(drawing.value.friction, 2)}, as above</option>
          <option value="least">least that does, by bisection</option>
          <option value="slices">several: {now.slices.map((v) => fixed(v, 2)).join(", ")}</option>
        </select>
      </div>
      {asksSteps(now) && <Steps />}
    </>
  );
}

function Steps() {
  return (
    <div class="range steps">
      <span>Steps</span>
      <CountField
        label="Number of steps"
        value={form.value.steps}
        max={50}
        class="few"
        onChange={(steps) => change({ steps })}
      />
    </div>
  );
}

function Second() {
  const others = allRobots.value
    .map(({ name }) => name)
    .filter((name) => name !== robotName.value || edited.value);
  const { second } = form.value;
  return (
    <div class="pick">
      <label for="map-second">vs</label>
      <select
        id="map-second"
        value={second && others.includes(second) ? second : ""}
        onChange={(event) => change({ second: event.currentTarget.value || null })}
      >
        <option value="">no other robot</option>
        {others.map((name) => (
          <option key={name} value={name}>
            {name === robotName.value ? `${name} as stored` : name}
          </option>
        ))}
      </select>
    </div>
  );
}

interface CheckProps {
  label: string;
  on: boolean;
  flip: () => void;
  title?: string;
  dash?: readonly number[];
}

function Check({ label, on, flip, title, dash }: CheckProps) {
  return (
    <label class="chk" title={title}>
      <input type="checkbox" checked={on} onChange={flip} />
      {label}
      {dash && (
        <svg viewBox="0 0 22 10" aria-hidden="true">
          <rect x="1" y="1" width="20" height="8" stroke-dasharray={dash.join(" ")} />
        </svg>
      )}
    </label>
  );
}
