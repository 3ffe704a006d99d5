/** The row of plots, all on one clock. */

import { computed } from "@preact/signals";
import { useLayoutEffect, useRef } from "preact/hooks";
import { hasFailed } from "../api/types";
import { live, livePlan } from "../state/live";
import { plan } from "../state/planning";
import { plannedEnd, shownRun } from "../state/playback";
import { progress, run, runB, running, runPlan } from "../state/rollouts";
import { compare, robot } from "../state/setup";
import type { Tint } from "./chart";
import { type Panel, type Source, timeAxis } from "./lines";
import { buildPanel } from "./panels";
import { Plot } from "./plot";
import { alonePlot, roomFor, rowWidth, shownPanels } from "./room";

/** While a rollout runs, its lines grow on the plan's bands. */
const growing = computed(() => running.value === "a");

const source = computed<Source>(() => {
  const limit = robot.value?.limit;
  const result = growing.value ? null : run.value;
  // A cancelled run stays as far as it came, until there is another.
  const part = growing.value || (!run.value && shownRun.value !== null);
  const driven = part ? livePlan.value : runPlan.value;
  const drive = part ? live.value : run.value;
  return {
    plan: (drive && driven) ?? plan.value,
    run: drive,
    runB: compare.value && result ? runB.value : null,
    legLimit: limit?.leg ?? Number.NaN,
    wheelLimit: limit?.wheel ?? Number.NaN,
  };
});

const panels = computed(() => {
  const time = timeAxis(source.value);
  const alone = alonePlot.value;
  const ids = alone ? [alone] : shownPanels.value.slice(0, roomFor(rowWidth.value));
  return ids.map((id) => buildPanel(id, source.value, time));
});

const tint = computed<Tint | null>(() => {
  const shown = source.value.plan;
  const total = shown?.timing.total ?? 0;
  if (growing.value) {
    const times = live.value?.series.time;
    return { from: 0, to: times?.[times.length - 1] ?? progress.value * total, kind: "done" };
  }
  const result = source.value.run;
  const end = result?.series.time[result.series.time.length - 1] ?? 0;
  if (hasFailed(result))
    return { from: end, to: Math.max(end, total, plannedEnd.value), kind: "failed" };
  if (shown?.problem) {
    const stop = shown.poses[shown.poses.length - 1]?.time ?? 0;
    return { from: stop, to: total, kind: "unplanned" };
  }
  return null;
});

/** The margins tell more in their heading than the others. */
const columns = (shown: readonly Panel[]) =>
  shown.map((panel) => `minmax(0, ${panel.id === "margins" ? 1.3 : 1}fr)`).join(" ");

export function Plots() {
  const row = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => {
    const element = row.current!;
    const observer = new ResizeObserver(() => {
      rowWidth.value = element.clientWidth;
    });
    observer.observe(element);
    return () => observer.disconnect();
  }, []);
  const { plan: shown, run: drive } = source.value;
  if (!drive && !shown?.poses.length) {
    const why = shown
      ? "No pose was found, so there is nothing to plot."
      : "Tracking plots appear when there is a plan.";
    return (
      <div class="plots none" ref={row}>
        {why}
      </div>
    );
  }
  const dim = run.value && !shownRun.value && !growing.value;
  return (
    <div
      ref={row}
      class={dim ? "plots older" : "plots"}
      style={{ "--columns": columns(panels.value) }}
    >
      {panels.value.map((panel) => (
        <Plot key={panel.id} panel={panel} tint={tint.value} />
      ))}
    </div>
  );
}
