/** How far the world may be from what is drawn, and what the plan still keeps there. */

import type { Plan } from "../api/types";
import { fixed, reason } from "../geometry/format";
import { PlanOtherEnd } from "../plan/other-end";
import { plan, stale } from "../state/planning";
import { setTolerance, tolerance, toleranceSchema } from "../state/setup";
import { SettingRow } from "./setting-row";

const WITHIN = " within tolerance";

export function Tolerance() {
  return (
    <section class="tolerance" aria-label="Tolerance">
      <h3>Tolerance</h3>
      {Object.entries(toleranceSchema.value).map(([name, schema]) => (
        <SettingRow
          key={name}
          name={name}
          schema={schema}
          value={tolerance.value[name]}
          onChange={(value) => setTolerance(name, value)}
        />
      ))}
      {Object.keys(tolerance.value).length > 0 && <Stood />}
    </section>
  );
}

/** What the certificate says of it: the least of each margin over all that may be. */
function Stood() {
  const now = plan.value;
  if (!now || stale.value) return <p class="effect-wait">Planning with that tolerance …</p>;
  if (now.problem) {
    return (
      <p class="effect-wait">
        {reason(now.problem.message)} <PlanOtherEnd of={now} />
      </p>
    );
  }
  return (
    <dl aria-label="Least margins within tolerance">
      {checksOf(now).map((check) => (
        <div key={check.name}>
          <dt>{check.name.replace(WITHIN, "")}</dt>
          <dd>
            {check.unit === "m" ? `${fixed(check.value * 1e3, 0)} mm` : fixed(check.value, 2)}
          </dd>
        </div>
      ))}
    </dl>
  );
}

const checksOf = (shown: Plan) =>
  shown.certificate?.checks.filter((check) => check.name.endsWith(WITHIN)) ?? [];
