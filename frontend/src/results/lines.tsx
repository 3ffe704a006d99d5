/** On narrow pages the results are lines of figures: those of A, those of B, and the sentences. */

import { hasFailed, type Plan, type Rollout } from "../api/types";
import { degrees, fixed, maybe } from "../geometry/format";
import { runB, runPlan, runPlanB, runStale } from "../state/rollouts";
import { compare } from "../state/setup";
import { Explanation, Heading } from "./card";
import { OUTCOMES } from "./figures";

export function Lines({ result }: { result: Rollout }) {
  const other = compare.value ? runB.value : null;
  return (
    <div class={runStale.value ? "lines older" : "lines"}>
      <div>
        <Heading result={result} />
        <Figures of={result} plan={runPlan.value} />
      </div>
      {other && (
        <div>
          <b class={hasFailed(other) ? "x" : ""}>B: {OUTCOMES[other.outcome]}</b>
          <Figures of={other} plan={runPlanB.value} />
        </div>
      )}
      <Explanation result={result} />
    </div>
  );
}

function Figures({ of, plan }: { of: Rollout; plan: Plan | null }) {
  const m = of.metrics;
  return (
    <>
      <span>
        {fixed(m.duration, 1)} s{hasFailed(of) && " until it ended"}
      </span>
      <span>
        pitch error {fixed(degrees(m.pitch_error_max), 1)}° max,{" "}
        {fixed(degrees(m.pitch_error_rms), 1)}° rms
      </span>
      <span>
        peak torque {fixed(m.torque_peak, 1)} Nm, {maybe(m.torque_rms, 1, " Nm")} rms
      </span>
      <span>{m.link_contacts} link contacts</span>
      <span>mean speed {fixed(m.speed_mean, 2)} m/s</span>
      {m.speed_stairs && <span>on the stairs {fixed(m.speed_stairs, 2)} m/s</span>}
      <span>
        energy {fixed(m.energy, 0)} J, planned {maybe(plan?.energy, 0, " J")}
      </span>
      <span>
        cost of transport {maybe(m.cost_of_transport, 2)}, planned{" "}
        {maybe(plan?.cost_of_transport, 2)}
      </span>
    </>
  );
}
