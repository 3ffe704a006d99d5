/** What came of the rollout, or why there is none. */

import type { Plan } from "../api/types";
import { about, capital, fixed, reason } from "../geometry/format";
import { live, livePlan } from "../state/live";
import { plan } from "../state/planning";
import { activity, eta, failure, progress, run, running } from "../state/rollouts";
import { isNarrow } from "../state/view";
import { Icon } from "../ui/icon";
import { Card } from "./card";
import { PLANNED } from "./figures";
import { Lines } from "./lines";

export function Results() {
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: it scrolls, and the keyboard must reach that
    <section class="res" aria-label="Results" tabIndex={0}>
      <Content />
    </section>
  );
}

function Content() {
  if (running.value === "a") return <Running />;
  if (activity.value === "failed" || activity.value === "cancelled") return <NotRun />;
  if (run.value) return isNarrow.value ? <Lines result={run.value} /> : <Card result={run.value} />;
  if (plan.value?.problem) {
    const { problem, poses } = plan.value;
    const turn = problem.feasible_facing ? ` or plan ${problem.feasible_facing}` : "";
    const remedy = `Change the marked spot${turn}, then run it.`;
    return (
      <>
        <h2 class="bad">
          <Icon name="warning" />
          No rollout
        </h2>
        <p>
          {poses.length > 0
            ? `The plan stops after ${fixed(problem.progress, 2)} m, so the plots show only that part. ${remedy}`
            : `No pose was found at the start. ${remedy}`}
        </p>
      </>
    );
  }
  const motion = plan.value?.certificate?.motion;
  return (
    <>
      <h2>Results</h2>
      {motion && <p>{capital(motion.message)}</p>}
      <p>
        {plan.value
          ? "Run the rollout to see outcome, pitch error, peak torque and speed. The plots show the plan."
          : "Outcome, pitch error, peak torque and speed appear here after a rollout."}
      </p>
      {plan.value && !isNarrow.value && <Planned shown={plan.value} />}
    </>
  );
}

/** What the plan itself says of its cost; margins have their own place. */
function Planned({ shown }: { shown: Plan }) {
  return (
    <div class="card">
      <table aria-label="The plan">
        <tbody>
          {PLANNED.map(({ title, hint, of }) => (
            <tr key={title} title={hint}>
              <th scope="row">
                {title} <small>planned</small>
              </th>
              <td class="a">{of(shown)}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

function Running() {
  const total = (livePlan.value ?? plan.value)?.timing.total ?? 0;
  const times = live.value?.series.time ?? [];
  const now = times[times.length - 1] ?? progress.value * total;
  return (
    <>
      <h2>
        <span class="spin" />
        Running
        <small>
          {fixed(now, 1)} s, {fixed(progress.value * 100, 0)} %
        </small>
      </h2>
      <p>
        {eta.value !== null && `${capital(about(eta.value))} left. `}Editing the profile keeps this
        run.
      </p>
    </>
  );
}

function keptText(): string {
  const times = live.value?.series.time;
  const end = times?.[times.length - 1];
  return end
    ? `Its first ${fixed(end, 1)} s are kept: timeline and plots show them until the next run.`
    : "It had not begun to move, so timeline and plots show the plan.";
}

function NotRun() {
  const cancelled = activity.value === "cancelled";
  return (
    <>
      <h2 class={cancelled ? "mute" : "bad"}>
        <Icon name={cancelled ? "close" : "warning"} />
        {cancelled ? "Cancelled" : "Could not run"}
      </h2>
      <p>
        {cancelled
          ? `The rollout was stopped. ${keptText()}`
          : failure.value && reason(failure.value)}
      </p>
    </>
  );
}
