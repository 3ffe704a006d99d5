/** Method, comparison, weights and controller: every row is built from the service's schema. */

import { useState } from "preact/hooks";
import type { Method } from "../api/types";
import { Effect } from "../plan/effect";
import {
  changedCount,
  changedWeights,
  compare,
  controller,
  controllerSchema,
  method,
  resetAll,
  seed,
  setController,
  setWeight,
  weightSchema,
} from "../state/setup";
import { inspectorOpen } from "../state/view";
import { Icon } from "../ui/icon";
import { NumberField } from "../ui/number-field";
import { SettingRow, Switch } from "./slider";

const METHODS: [Method, string][] = [
  ["path", "Path"],
  ["critical", "Paper: critical poses"],
];

type Page = "weights" | "controller";
const PAGES: [Page, string][] = [
  ["weights", "Weights"],
  ["controller", "Controller"],
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
          <div class="settings">{page === "weights" ? <Weights /> : <Controller />}</div>
        </div>
      )}
    </section>
  );
}

interface SegmentsProps<T extends string> {
  label: string;
  /** In a header: no visible label. */
  small?: boolean;
  options: [T, string][];
  value: T;
  onChoose: (value: T) => void;
}

function Segments<T extends string>({ label, small, options, value, onChoose }: SegmentsProps<T>) {
  const onKeyDown = (event: KeyboardEvent) => {
    const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!by) return;
    event.preventDefault();
    event.stopPropagation();
    const at = options.findIndex(([each]) => each === value);
    const next = (at + by + options.length) % options.length;
    onChoose(options[next]![0]);
    (event.currentTarget as HTMLElement)
      .querySelectorAll<HTMLElement>("[role=radio]")
      [next]?.focus();
  };
  return (
    <div class={small ? "r2 small" : "r2"}>
      {!small && <span class="lab">{label}</span>}
      <div class="seg" role="radiogroup" aria-label={label} tabIndex={-1} onKeyDown={onKeyDown}>
        {options.map(([each, text]) => (
          <button
            key={each}
            type="button"
            role="radio"
            tabIndex={each === value ? 0 : -1}
            aria-checked={each === value}
            class={each === value ? "on" : ""}
            onClick={() => onChoose(each)}
          >
            {text}
          </button>
        ))}
      </div>
    </div>
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
      <Effect />
    </>
  );
}

const SEEDS = 2 ** 31 - 1;

function Controller() {
  return (
    <>
      <div class="w" title="Seed of the rollout's sensor noise and disturbances">
        <span class="wl">Seed</span>
        <span class="push">
          <NumberField
            label="Seed"
            value={seed.value}
            min={0}
            max={SEEDS}
            step={1}
            format={String}
            onChange={(v) => {
              seed.value = Math.round(v);
            }}
          />
        </span>
        <span />
      </div>
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
