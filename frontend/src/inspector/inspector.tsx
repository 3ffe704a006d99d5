/** Method, comparison, weights and controller: every row is built from the service's schema. */

import type { FacingChoice, Method, PlanTiming } from "../api/types";
import { Effect } from "../plan/effect";
import { SaferEnd } from "../plan/other-end";
import {
  changedCount,
  changedWeights,
  compare,
  controller,
  controllerSchema,
  facing,
  method,
  resetAll,
  setController,
  setFacing,
  setWeight,
  timing,
  weightSchema,
} from "../state/setup";
import { type InspectorPage, inspectorOpen, inspectorPage } from "../state/view";
import { Icon } from "../ui/icon";
import { Switch } from "../ui/switch";
import { SeedRow } from "./seed";
import { Choice, Segments } from "./segments";
import { SettingGroups } from "./setting-groups";
import { SettingRow } from "./setting-row";
import { Tolerance } from "./tolerance";
import { DisturbancesAndTrials } from "./trials";

const METHODS: [Method, string][] = [
  ["path", "Path"],
  ["critical", "Paper: critical poses"],
];

const FACINGS: [FacingChoice, string][] = [
  ["forward", "Forward"],
  ["backward", "Backward"],
  ["either", "Either"],
];

const TIMINGS: [PlanTiming, string][] = [
  ["steady", "Steady"],
  ["fast", "Fast"],
];

const PAGES: [InspectorPage, string][] = [
  ["plan", "Plan"],
  ["controller", "Controller"],
  ["trials", "Trials"],
];

export function Inspector() {
  const page = inspectorPage.value;
  const open = inspectorOpen.value;
  return (
    <section class={open ? "insp" : "insp shut"} aria-label="Inspector">
      <div class="ph">
        <h2>
          Inspector
          {changedCount.value > 0 && <small>{changedCount.value} changed</small>}
        </h2>
        {changedCount.value > 0 && open && (
          <button type="button" class="t" onClick={resetAll}>
            Reset all
          </button>
        )}
        {open && <Choice small label="Settings" options={PAGES} of={inspectorPage} />}
        <button
          type="button"
          class="t ico"
          aria-label={open ? "Collapse inspector" : "Expand inspector"}
          aria-expanded={open}
          onClick={() => {
            inspectorOpen.value = !open;
          }}
        >
          <Icon name="down" turn={!open} />
        </button>
      </div>
      {open && (
        <div class="bd">
          {page === "plan" && <Planning />}
          <div class="settings">
            {page === "plan" && <Weights />}
            {page === "controller" && <Controller />}
            {page === "trials" && <DisturbancesAndTrials />}
          </div>
        </div>
      )}
    </section>
  );
}

/** How the plan is made, and the plan that it is compared with. */
function Planning() {
  return (
    <>
      <Choice label="Method" options={METHODS} of={method} />
      {method.value === "path" && <Choice label="Timing" options={TIMINGS} of={timing} />}
      <Segments label="Facing" options={FACINGS} value={facing.value} onChoose={setFacing} />
      <SaferEnd />
      <div class="r2 cmp-row">
        <span class="lab">Compare</span>
        <div class="ab">
          <span>
            <i />A planned
          </span>
          <span>
            <i />B nominal pose
          </span>
        </div>
        <Switch
          label="Compare A with B"
          on={compare.value}
          onChange={(on) => {
            compare.value = on;
          }}
        />
      </div>
    </>
  );
}

function Weights() {
  return (
    <>
      {Object.entries(weightSchema.value).map(([name, schema]) => (
        <SettingRow
          key={`${method.value}-${name}`}
          name={name}
          schema={schema}
          value={changedWeights.value[name]}
          onChange={(value) => setWeight(name, value)}
        />
      ))}
      {method.value === "path" && <Tolerance />}
      <Effect />
    </>
  );
}

function Controller() {
  return (
    <>
      <SeedRow />
      <SettingGroups
        schemas={controllerSchema.value}
        values={controller.value}
        unchanged="default"
        onChange={setController}
      />
    </>
  );
}
