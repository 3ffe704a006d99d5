/** What came of a set of trials: success rate, spread of the pitch error, the worst ones. */

import type { Trial, Trials } from "../api/types";
import { degrees, fixed } from "../geometry/format";
import { withUnit } from "../geometry/units";
import { OUTCOMES, verdict } from "../results/figures";
import { canRun } from "../state/rollouts";
import { disturbanceSchema } from "../state/setup";
import { deviations, replay, trialsStale, worstTrials } from "../state/trials";
import { Icon } from "../ui/icon";

const BINS = 12;
const SHOWN = 3;
const percent = (share: number) => fixed(share * 100, 0);
const titleOf = (name: string) => disturbanceSchema.value[name]?.title ?? name;

export function TrialsResult({ found }: { found: Trials }) {
  const [low, high] = found.clopper_pearson as [number, number];
  const suspects = Object.entries(found.suspects ?? {});
  return (
    <div class={trialsStale.value ? "trials-result older" : "trials-result"}>
      <p class="trials-rate">
        <b class={found.successes === found.count ? "" : "bad"}>
          {found.successes} / {found.count}
        </b>{" "}
        succeed; 95 % interval {percent(low)} to {percent(high)} %
        {trialsStale.value && <small> of the previous plan</small>}
      </p>
      <Histogram found={found} />
      {suspects.length > 0 && (
        <p>
          Larger in failed trials than in the others:{" "}
          {suspects
            .slice(0, SHOWN)
            .map(([name, share]) => `${titleOf(name)} (${percent(share)} % of pairs)`)
            .join(", ")}
          .
        </p>
      )}
      <h3>Worst trials</h3>
      <ul>
        {worstTrials.value.slice(0, SHOWN).map((trial) => (
          <Worst key={trial.seed} trial={trial} />
        ))}
      </ul>
    </div>
  );
}

function Worst({ trial }: { trial: Trial }) {
  const words = Object.entries(deviations(trial)).map(
    ([name, value]) =>
      `${titleOf(name)} ${withUnit(value as number, disturbanceSchema.value[name], true)}`,
  );
  return (
    <li title={words.join(", ")}>
      <span class={verdict(trial.outcome)}>{OUTCOMES[trial.outcome]}</span>
      <span title="Largest pitch error">{fixed(degrees(trial.pitch_error_max), 1)}°</span>
      <small>seed {trial.seed}</small>
      <button
        type="button"
        class="t"
        aria-label={`Replay the trial with seed ${trial.seed}`}
        disabled={!canRun.value || trialsStale.value}
        onClick={() => replay(trial)}
      >
        <Icon name="reset" />
        Replay
      </button>
    </li>
  );
}

/** Numbers of trials by their largest pitch error; failures on top, hatched. */
function Histogram({ found }: { found: Trials }) {
  const errors = found.trials.map((trial) => degrees(trial.pitch_error_max));
  const most = Math.max(...errors, 1e-6);
  const bins = Array.from({ length: BINS }, () => ({ good: 0, bad: 0 }));
  found.trials.forEach((trial, i) => {
    const bin = bins[Math.min(BINS - 1, Math.floor((errors[i]! / most) * BINS))]!;
    if (trial.outcome === "success") bin.good++;
    else bin.bad++;
  });
  const tallest = Math.max(...bins.map((bin) => bin.good + bin.bad));
  return (
    <figure class="histogram">
      <div
        role="img"
        aria-label={`Largest pitch error of ${found.count} trials, up to ${fixed(most, 1)} degrees`}
      >
        {bins.map((bin, i) => (
          <span key={i} title={`${bin.good + bin.bad} trials`}>
            <i class="bad" style={{ height: `${(bin.bad / tallest) * 100}%` }} />
            <i style={{ height: `${(bin.good / tallest) * 100}%` }} />
          </span>
        ))}
      </div>
      <figcaption>
        <span>0°</span>
        <span>largest pitch error of a trial</span>
        <span>{fixed(most, 1)}°</span>
      </figcaption>
    </figure>
  );
}
