/** The stretch of time that all plots show. */

import { computed, effect, signal } from "@preact/signals";
import type { Drive } from "../api/types";
import { delay } from "../geometry/frames";
import { live, livePlan } from "../state/live";
import { plannedEnd } from "../state/playback";
import { run, runPlan } from "../state/rollouts";

const chosen = signal<[number, number] | null>(null);
/** A rollout of the previous plan keeps its own axis. */
const end = computed(() => {
  if (livePlan.value && live.value?.outcome !== "cancelled") return runningEnd();
  const times = run.value?.series.time;
  if (!times) return plannedEnd.value;
  const shown = runPlan.value;
  const planned =
    !shown || run.value?.outcome === "success" ? 0 : shown.timing.total + delay(shown, run.value!);
  return Math.max(times[times.length - 1] ?? 0, planned);
});
const whole = computed<[number, number]>(() => [0, Math.max(end.value, 0.5)]);

export const timeWindow = {
  get value(): [number, number] {
    return chosen.value ?? whole.value;
  },
  set value(next: [number, number]) {
    chosen.value = next;
  },
  peek(): [number, number] {
    return chosen.peek() ?? whole.peek();
  },
};

/** Room for all that is planned, so that the axis stands while the lines grow. */
function runningEnd(): number {
  const planned = livePlan.value?.timing.total;
  return planned === undefined ? plannedEnd.value : Math.max(planned, lastTime(live.value));
}

const lastTime = (drive: Drive | null) => drive?.series.time[drive.series.time.length - 1] ?? 0;

/** Zoom by `factor` around a time; beyond the whole it shows all. */
export function zoomTime(around: number, factor: number): void {
  const [from, to] = timeWindow.peek();
  const end = whole.peek()[1];
  const width = (to - from) * factor;
  if (!(width < end)) {
    chosen.value = null;
    return;
  }
  const start = Math.min(end - width, Math.max(0, around - (around - from) * factor));
  chosen.value = [start, start + Math.max(width, 0.02)];
}

/** Another duration is another axis: a zoom into the old one means nothing there. */
effect(() => {
  whole.value;
  chosen.value = null;
});
