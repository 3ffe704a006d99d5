/** What came of the rollout, A beside B. */

import { hasFailed, type Metrics, type Outcome, type Plan, type Rollout } from "../api/types";
import { degrees, fixed, took } from "../geometry/format";
import { live, livePlan } from "../state/live";
import { plan } from "../state/planning";
import {
  activity,
  eta,
  failure,
  failureB,
  progress,
  run,
  runB,
  running,
  runOf,
  runPlan,
  runPlanB,
  runStale,
} from "../state/rollouts";
import { compare, robot } from "../state/setup";
import { isNarrow } from "../state/view";
import { Icon } from "../ui/icon";

export const OUTCOMES: Record<Outcome, string> = {
  success: "Success",
  fell: "Fell",
  stuck: "Stuck",
  collided: "Collided",
  diverged: "Diverged",
  timeout: "Ran out of time",
  stopped: "Stopped safely",
};

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
    return (
      <>
        <h2 class="bad">
          <Icon name="warning" />
          No rollout
        </h2>
        <p>
          {poses.length > 0
            ? `The plan stops after ${fixed(problem.progress, 2)} m, so the plots show only that part. Change the marked spot, then run it.`
            : "No pose was found at the start. Change the marked spot, then run it."}
        </p>
      </>
    );
  }
  const motion = plan.value?.certificate?.motion;
  return (
    <>
      <h2>Results</h2>
      {motion && <p>{motion.message}</p>}
      <p>
        {plan.value
          ? "Run the rollout to see outcome, pitch error, peak torque and speed. The plots show the plan."
          : "Outcome, pitch error, peak torque and speed appear here after a rollout."}
      </p>
    </>
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
        {eta.value !== null ? `About ${fixed(eta.value, 0)} s left. ` : ""}Editing the profile keeps
        this run.
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
      <p>{cancelled ? `The rollout was stopped. ${keptText()}` : failure.value}</p>
    </>
  );
}

interface Row {
  title: string;
  unit?: string;
  of: (m: Metrics, r: Rollout, p: Plan | null) => string;
  bad?: (m: Metrics, r: Rollout) => boolean;
}

/** More than this, and the robot was not tracking any more [rad]. */
const LOST = (10 * Math.PI) / 180;

function rows(results: Rollout[]): Row[] {
  const limit = robot.value?.limit.leg;
  const outcome: Row = {
    title: "Outcome",
    of: (_m, r) => OUTCOMES[r.outcome],
    bad: (_m, r) => hasFailed(r),
  };
  return [
    ...(results.length > 1 ? [outcome] : []),
    {
      title: "Duration",
      of: (m) => `${fixed(m.duration, 1)} s`,
      bad: (_m, r) => hasFailed(r),
    },
    {
      title: "Pitch error",
      unit: "largest",
      of: (m) => `${fixed(degrees(m.pitch_error_max), 1)}°`,
      bad: (m) => m.pitch_error_max > LOST,
    },
    { title: "Pitch error", unit: "rms", of: (m) => `${fixed(degrees(m.pitch_error_rms), 1)}°` },
    {
      title: "Peak torque",
      ...(limit ? { unit: `of ${fixed(limit, 1)} Nm` } : {}),
      of: (m) => `${fixed(m.torque_peak, 1)} Nm`,
      bad: (m) => limit !== undefined && m.torque_peak >= limit - 0.05,
    },
    { title: "Energy", of: (m) => `${fixed(m.energy, 0)} J` },
    { title: "Link contacts", of: (m) => String(m.link_contacts), bad: (m) => m.link_contacts > 0 },
    { title: "Mean speed", of: (m) => `${fixed(m.speed_mean, 2)} m/s` },
    { title: "Planned in", of: (_m, _r, p) => (p ? took(p.solve_time) : "–") },
  ];
}

/** What a figure cannot say: why it failed, what was known before, why B is missing. */
function Explanation({ result }: { result: Rollout }) {
  const motion = runPlan.value?.certificate?.motion;
  return (
    <>
      {result.reason && result.outcome !== "success" && <p>{result.reason}</p>}
      {motion && <p class="warn">{motion.message}</p>}
      <WithoutB />
    </>
  );
}

function Heading({ result }: { result: Rollout }) {
  const good = result.outcome === "success";
  // A collision is judged at the end; the sentence below says when it happened.
  const dated = !good && result.outcome !== "collided";
  return (
    <h2 class={good ? "" : "bad"}>
      <Icon name={good ? "check" : "warning"} />
      {OUTCOMES[result.outcome]}
      {dated && ` at ${fixed(result.metrics.duration, 1)} s`}
      <small>{runOf.value ?? `seed ${result.seed ?? 0}`}</small>
    </h2>
  );
}

function Card({ result }: { result: Rollout }) {
  const other = compare.value ? runB.value : null;
  const cell = (row: Row, r: Rollout, p: Plan | null, cls: string) => (
    <td class={row.bad?.(r.metrics, r) ? `${cls} x` : cls}>{row.of(r.metrics, r, p)}</td>
  );
  return (
    <div class={runStale.value ? "older" : ""}>
      <Heading result={result} />
      <Explanation result={result} />
      <table class={other ? "two" : ""}>
        {other && (
          <thead>
            <tr>
              <th scope="col">
                <span class="sr">Figure</span>
              </th>
              <th scope="col">A</th>
              <th scope="col">B</th>
            </tr>
          </thead>
        )}
        <tbody>
          {rows(other ? [result, other] : [result]).map((row) => (
            <tr key={`${row.title} ${row.unit}`}>
              <th scope="row">
                {row.title} {row.unit && <small>{row.unit}</small>}
              </th>
              {cell(row, result, runPlan.value, "a")}
              {other && cell(row, other, runPlanB.value, "b")}
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

/** Why A stands alone while two are compared. */
function WithoutB() {
  if (!compare.value || runB.value) return null;
  if (running.value === "b") return <p>B is running, {fixed(progress.value * 100, 0)} %.</p>;
  return failureB.value && <p>B has no rollout: {failureB.value}</p>;
}

/** On narrow pages the card is a line of figures, B's below it, and the sentences. */
function Lines({ result }: { result: Rollout }) {
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
    </>
  );
}
