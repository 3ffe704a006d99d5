/** Disturbances of the single rollout, and trials that draw theirs at random. */

import { about, capital, fixed } from "../geometry/format";
import { plan } from "../state/planning";
import { disturbance, disturbanceSchema, setDisturbance, settings } from "../state/setup";
import {
  bundle,
  cancelTrials,
  canTry,
  count,
  MOST_TRIALS,
  startTrials,
  trials,
  trialsEta,
  trialsFailure,
  trialsProgress,
  trialsRunning,
} from "../state/trials";
import { NumberField } from "../ui/number-field";
import { SeedRow } from "./seed";
import { Segments } from "./segments";
import { SettingGroups } from "./setting-groups";
import { TrialsResult } from "./trials-result";

const NONE = "none";

export function DisturbancesAndTrials() {
  const names = Object.keys(settings.value?.bundles ?? {});
  const options = [NONE, ...names].map((name): [string, string] => [name, capital(name)]);
  const changed = Object.keys(disturbance.value).length;
  return (
    <section class="trials" aria-label="Disturbances and trials">
      <Segments
        label="Trials"
        options={options}
        value={bundle.value ?? NONE}
        onChoose={(name) => {
          bundle.value = name === NONE ? null : name;
        }}
      />
      {bundle.value !== null && <Start />}
      {trialsFailure.value && (
        <p class="error" role="alert">
          The trials could not be run. {trialsFailure.value}
        </p>
      )}
      {trials.value && <TrialsResult found={trials.value} />}
      <h3>
        Disturbances of one rollout
        <small>{changed > 0 ? `${changed} set` : "none"}</small>
        {changed > 0 && (
          <button
            type="button"
            class="t"
            onClick={() => {
              disturbance.value = {};
            }}
          >
            Clear
          </button>
        )}
      </h3>
      <div class="settings-rows">
        <SeedRow />
        <SettingGroups
          schemas={disturbanceSchema.value}
          values={disturbance.value}
          unchanged="none"
          onChange={setDisturbance}
        />
      </div>
    </section>
  );
}

function Start() {
  if (trialsRunning.value) {
    const eta = trialsEta.value;
    const done = Math.round(trialsProgress.value * 100);
    return (
      <div class="trials-run">
        <progress aria-label="Trials" max={1} value={trialsProgress.value} />
        <span>
          {done} %{eta === null ? "" : `, ${about(eta)} left`}
        </span>
        <button type="button" class="btn" onClick={cancelTrials}>
          Cancel
        </button>
      </div>
    );
  }
  return (
    <div class="trials-run">
      <NumberField
        label="Number of trials"
        value={count.value}
        min={1}
        max={MOST_TRIALS}
        step={1}
        format={(value) => fixed(value, 0)}
        onChange={(value) => {
          count.value = Math.round(value);
        }}
      />
      <button
        type="button"
        class="btn"
        disabled={!canTry.value}
        title={
          plan.value?.status === "feasible" ? undefined : "Only a feasible plan can be tried out"
        }
        onClick={() => void startTrials()}
      >
        Run {count.value} trials
      </button>
    </div>
  );
}
