/** Method, comparison, weights and controller: every row is built from the service's schema. */

import { useState } from "preact/hooks";
import type { Method, PlanTiming } from "../api/types";
import { Effect } from "../plan/effect";
import {
  changedCount,
  changedWeights,
  compare,
  controller,
  controllerSchema,
  method,
  resetAll,
  setController,
  setWeight,
  timing,
  weightSchema,
} from "../state/setup";
import { inspectorOpen } from "../state/view";
import { Icon } from "../ui/icon";
import { SeedRow } from "./seed";
import { Segments } from "./segments";
import { SettingRow, Switch } from "./slider";
import { Tolerance } from "./tolerance";
import { DisturbancesAndTrials } from "./trials";

const METHODS: [Method, string][] = [
  ["path", "Path"],
  ["critical", "Paper: critical poses"],
];

const TIMINGS: [PlanTiming, string][] = [
  ["steady", "Steady"],
  ["fast", "Fast"],
];

type Page = "weights" | "controller" | "trials";
const PAGES: [Page, string][] = [
  ["weights", "Weights"],
  ["controller", "Controller"],
  ["trials", "Trials"],
];

export function Inspector() {
  const [page, setPage] = useState<Page>("weights");
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
        {open && (
          <Segments small label="Settings" options={PAGES} value={page} onChoose={setPage} />
        )}
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
          <Segments
            label="Method"
            options={METHODS}
            value={method.value}
            onChoose={(next) => {
              method.value = next;
            }}
          />
          {method.value === "path" && (
            <Segments
              label="Timing"
              options={TIMINGS}
              value={timing.value}
              onChoose={(next) => {
                timing.value = next;
              }}
            />
          )}
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
          <div class="settings">
            {page === "weights" && <Weights />}
            {page === "controller" && <Controller />}
            {page === "trials" && <DisturbancesAndTrials />}
          </div>
        </div>
      )}
    </section>
  );
}

function Weights() {
  // Some weights belong to one kind of timing alone.
  const shown = Object.entries(weightSchema.value).filter(
    ([, schema]) => !schema.timing || schema.timing === timing.value,
  );
  return (
    <>
      {shown.map(([name, schema]) => (
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
      {Object.entries(controllerSchema.value).map(([name, schema]) => (
        <SettingRow
          key={name}
          name={name}
          schema={schema}
          value={controller.value[name]}
          onChange={(value) => setController(name, value)}
        />
      ))}
    </>
  );
}
