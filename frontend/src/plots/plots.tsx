/** The row of plots, all on one clock. */

import { computed, type ReadonlySignal } from "@preact/signals";
import { hasFailed } from "../api/types";
import { live, livePlan } from "../state/live";
import { plan, robotOf } from "../state/planning";
import { plannedEnd, shownRun } from "../state/playback";
import { progress, run, runB, running, runPlan } from "../state/rollouts";
import { compare } from "../state/setup";
import type { IconName } from "../ui/icon";
import { IconButton } from "../ui/icon-button";
import { useMeasured } from "../ui/measured";
import type { Tint } from "./chart";
import { PANELS, type Panel, type PanelId, type Source, timeAxis } from "./lines";
import { buildPanel } from "./panels";
import { Plot } from "./plot";
import { row, rowWidth, turnRow } from "./room";

/** While a rollout runs, its lines grow on the plan's bands. */
const growing = computed(() => running.value === "a");

const source = computed<Source>(() => {
  const result = growing.value ? null : run.value;
  // A cancelled run stays as far as it came, until there is another.
  const part = growing.value || (!run.value && shownRun.value !== null);
  const driven = part ? livePlan.value : runPlan.value;
  const drive = part ? live.value : run.value;
  const shown = (drive && driven) ?? plan.value;
  return {
    plan: shown,
    run: drive,
    runB: compare.value && result ? runB.value : null,
    limits: robotOf(shown)?.limits ?? null,
  };
});

const time = computed(() => timeAxis(source.value));

/** Each plot's content, computed while it is on screen. */
const panels = Object.fromEntries(
  (Object.keys(PANELS) as PanelId[]).map((id) => [
    id,
    computed(() => buildPanel(id, source.value, time.value)),
  ]),
) as Record<PanelId, ReadonlySignal<Panel>>;

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

/** Why there is nothing to plot, if so. */
const nothing = computed(() => {
  const { plan, run } = source.value;
  if (run || plan?.poses.length) return "";
  return plan
    ? "No pose was found, so there is nothing to plot."
    : "Tracking plots appear when there is a plan.";
});
/** What is plotted is a rollout of an older plan. */
const older = computed(() => Boolean(run.value && !shownRun.value && !growing.value));

/** The margins tell more in their heading than the others. */
const columns = (ids: readonly PanelId[]) =>
  ids.map((id) => `minmax(0, ${id === "margins" ? 1.3 : 1}fr)`).join(" ");

/** Leads to the plots that have no room in the row. */
function Turn({ to, steps, icon }: { to: readonly PanelId[]; steps: number; icon: IconName }) {
  const names = to.map((id) => PANELS[id]).join(", ");
  const label = to.length > 0 ? `Show ${names}` : "No more plots";
  return <IconButton action={() => turnRow(steps)} label={label} icon={icon} off={!to.length} />;
}

export function Plots() {
  const box = useMeasured((element) => {
    rowWidth.value = element.clientWidth;
  });
  if (nothing.value) {
    return (
      <div class="plots none" ref={box}>
        {nothing.value}
      </div>
    );
  }
  const { plots, left, right } = row.value;
  const aside = left.length + right.length > 0;
  return (
    <div
      ref={box}
      class={older.value ? "plots older" : "plots"}
      style={{ "--columns": columns(plots) + (aside ? " 28px" : "") }}
    >
      {plots.map((id) => (
        <Plot key={id} panel={panels[id]} tint={tint} />
      ))}
      {aside && (
        <nav class="turn" aria-label="More plots">
          <Turn to={right} steps={right.length} icon="right" />
          <Turn to={left} steps={-left.length} icon="left" />
        </nav>
      )}
    </div>
  );
}
