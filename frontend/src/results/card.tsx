/** What came of a rollout as a card of figures, B's beside A's. */

import { signal } from "@preact/signals";
import { useLayoutEffect, useRef } from "preact/hooks";
import type { Plan, Rollout } from "../api/types";
import { capital, fixed } from "../geometry/format";
import { robotOf } from "../state/planning";
import {
  failureB,
  progress,
  runB,
  running,
  runOf,
  runPlan,
  runPlanB,
  runStale,
} from "../state/rollouts";
import { compare } from "../state/setup";
import { Icon } from "../ui/icon";
import { type Figure, figures, OUTCOMES, verdict } from "./figures";

/** What a figure cannot say: why it failed, what was known before, why B is missing. */
export function Explanation({ result }: { result: Rollout }) {
  const motion = runPlan.value?.certificate?.motion;
  return (
    <>
      {result.reason && result.outcome !== "success" && <p>{result.reason}</p>}
      {motion && <p class="warn">{capital(motion.message)}</p>}
      <WithoutB />
    </>
  );
}

export function Heading({ result }: { result: Rollout }) {
  const good = result.outcome === "success";
  // A collision is judged at the end; the sentence below says when it happened.
  const dated = !good && result.outcome !== "collided";
  return (
    <h2 class={verdict(result.outcome)}>
      <Icon name={good ? "check" : "warning"} />
      {OUTCOMES[result.outcome]}
      {dated && ` at ${fixed(result.metrics.duration, 1)} s`}
      <small>{runOf.value ?? `seed ${result.seed ?? 0}`}</small>
    </h2>
  );
}

/** Heights of a row, and of all that stands around the rows [px]. */
const ROW = 18;
const AROUND = 42;
const SENTENCES = 40;

/** Height of the card's area: where its figures have no room below each other, they take two columns. */
const room = signal(0);

function useRoom() {
  const card = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => {
    const area = card.current?.parentElement;
    if (!area) return;
    const observer = new ResizeObserver(() => {
      room.value = area.clientHeight;
    });
    observer.observe(area);
    return () => observer.disconnect();
  }, []);
  return card;
}

export function Card({ result }: { result: Rollout }) {
  const card = useRoom();
  const other = compare.value ? runB.value : null;
  const results = other ? [result, other] : [result];
  const rows = (apart: boolean) => figures(results, robotOf(runPlan.value)?.limits, apart);
  const sentences = result.outcome !== "success" || runPlan.value?.certificate?.motion;
  const heads = other ? 1 : 0;
  const needed = AROUND + (sentences ? SENTENCES : 0) + (rows(Boolean(other)).length + heads) * ROW;
  const low = needed > room.value;
  // Two columns are too narrow for what stands beside a title, and have room for rows.
  const all = rows(low || Boolean(other));
  const half = Math.ceil(all.length / 2);
  const parts = low ? [all.slice(0, half), all.slice(half)] : [all];
  const kind = `${other ? "two" : "one"} ${low ? "low" : ""}`;
  return (
    <div class={runStale.value ? `card ${kind} older` : `card ${kind}`} ref={card}>
      <Heading result={result} />
      <Explanation result={result} />
      <div class="tables">
        {parts.map((part) => (
          <Table key={part[0]!.title} figures={part} result={result} other={other} />
        ))}
      </div>
    </div>
  );
}

interface TableProps {
  figures: Figure[];
  result: Rollout;
  other: Rollout | null;
}

function Table({ figures, result, other }: TableProps) {
  const cell = (figure: Figure, r: Rollout, plan: Plan | null, cls: string) => (
    <td class={figure.bad?.(r.metrics, r) ? `${cls} x` : cls}>{figure.of(r.metrics, r, plan)}</td>
  );
  return (
    <table>
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
        {figures.map((figure) => (
          <tr key={`${figure.title} ${figure.note}`} title={figure.hint}>
            <th scope="row">
              {figure.title} {figure.note && <small>{figure.note}</small>}
              {figure.planned && <small>plan {figure.planned(runPlan.value)}</small>}
              {figure.limit && <small class="limit-note">{figure.limit}</small>}
            </th>
            {cell(figure, result, runPlan.value, "a")}
            {other && cell(figure, other, runPlanB.value, "b")}
          </tr>
        ))}
      </tbody>
    </table>
  );
}

/** Why A stands alone while two are compared. */
function WithoutB() {
  if (!compare.value || runB.value) return null;
  if (running.value === "b") return <p>B is running, {fixed(progress.value * 100, 0)} %.</p>;
  return failureB.value && <p>B has no rollout: {failureB.value}</p>;
}
