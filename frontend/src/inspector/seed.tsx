/** The seed of whatever is random in a rollout or in trials. */

import { seed } from "../state/setup";
import { NumberField } from "../ui/number-field";

const SEEDS = 2 ** 31 - 1;

export function SeedRow() {
  return (
    <div
      class="w"
      title="Seed of sensor noise, of random step errors, and of what trials draw; a rollout without any of these is the same for every seed"
    >
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
  );
}
