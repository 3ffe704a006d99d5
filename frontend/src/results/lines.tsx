/** On narrow pages the results are lines of figures: those of A, those of B, and the sentences. */

import { hasFailed, type Rollout } from "../api/types";
import { degrees, fixed } from "../geometry/format";
import { runB, runStale } from "../state/rollouts";
import { compare } from "../state/setup";
import { Explanation, Heading } from "./card";
import { OUTCOMES } from "./figures";

export function Lines({ result }: { result: Rollout }) {
  const other = compare.value ? runB.value : null;
  return (
    <div class={runStale.value ? "lines older" : "lines"}>
      <div>
        <Heading result={result} />
        <Figures of={result} />
      </div>
      {other && (
        <div>
          <b class={hasFailed(other) ? "x" : ""}>B: {OUTCOMES[other.outcome]}</b>
          <Figures of={other} />
        </div>
      )}
      <Explanation result={result} />
    </div>
  );
}

function Figures({ of }: { of: Rollout }) {
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
      <span>torque {fixed(m.torque_peak, 1)} Nm</span>
      <span>{m.link_contacts} link contacts</span>
      <span>mean speed {fixed(m.speed_mean, 2)} m/s</span>
      {m.speed_stairs && <span>on the stairs {fixed(m.speed_stairs, 2)} m/s</span>}
      {m.cost_of_transport && <span>cost of transport {fixed(m.cost_of_transport, 2)}</span>}
    </>
  );
}
