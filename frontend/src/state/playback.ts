/** The one clock: time on the slider, in the plots, of the robot in 2-D and 3-D. */

import { computed, effect, signal } from "@preact/signals";
import { type Drive, hasFailed } from "../api/types";
import { delay, locate, planFrame, poseTimes, runFrame } from "../geometry/frames";
import { live, livePlan } from "./live";
import { plan, stale } from "./planning";
import { activity, run, runStale } from "./rollouts";

export const time = signal(0);
export const playing = signal(false);
export const speed = signal(1);
/** A plot under the pointer previews another time; null when none does. */
export const hoverTime = signal<number | null>(null);

export const SPEEDS = [0.25, 0.5, 1, 2, 4];

/** The drive that the clock runs on; one of an older plan only stays in the plots. */
export const shownRun = computed<Drive | null>(() => {
  if (live.value) return livePlan.value?.id === plan.value?.id && !stale.value ? live.value : null;
  return runStale.value ? null : run.value;
});

export const duration = computed(() => {
  const times = shownRun.value?.series.time;
  if (times) return times[times.length - 1] ?? 0;
  const shown = plan.value;
  if (!shown) return 0;
  const planned = poseTimes(shown);
  return planned[planned.length - 1] ?? 0;
});

/** The planned end: longer than `duration` where the robot fell on the way. */
export const plannedEnd = computed(() => {
  const shown = plan.value;
  if (!shown) return duration.value;
  const drive = shownRun.value;
  const late = drive && hasFailed(drive) ? delay(shown, drive) : 0;
  return Math.max(duration.value, shown.timing.total + late);
});

export const shownTime = computed(() => hoverTime.value ?? Math.min(time.value, duration.value));

export const frame = computed(() => {
  const rollout = shownRun.value;
  if (rollout) return runFrame(rollout, shownTime.value);
  return plan.value ? planFrame(plan.value, shownTime.value) : null;
});

/** The pose of the plan next to the clock, for margins and the centre of mass. */
export const poseIndex = computed(() => {
  const shown = plan.value;
  if (!shown || shown.poses.length === 0) return -1;
  const rollout = shownRun.value;
  if (!rollout) {
    const [i, f] = locate(poseTimes(shown), shownTime.value);
    return f > 0.5 ? i + 1 : i;
  }
  const [i] = locate(rollout.series.time, shownTime.value);
  const [k, f] = locate(
    shown.poses.map((p) => p.progress),
    rollout.series.progress[i] ?? 0,
  );
  return f > 0.5 ? k + 1 : k;
});

/** When the key poses are reached: by the plan, or by the robot where a rollout is shown. */
export const keyTimes = computed<number[]>(() => {
  const shown = plan.value;
  if (!shown) return [];
  const series = shownRun.value?.series;
  if (!series) return shown.critical.map((i) => poseTimes(shown)[i] ?? 0);
  const end = series.progress[series.progress.length - 1] ?? 0;
  return shown.critical.flatMap((i) => {
    const at = shown.poses[i]?.progress ?? 0;
    if (at > end + 0.01) return [];
    const k = series.progress.findIndex((p) => p >= at);
    return [series.time[k < 0 ? series.time.length - 1 : k] ?? 0];
  });
});

/** Less than a plan that has begun to move [m]. */
const AT_REST = 1e-4;

/** When the robot that is shown set off [s]: before that it settles, or tests its grip. */
export const setsOff = computed<number>(() => {
  const series = shownRun.value?.series;
  const asked = series?.progress_desired;
  if (!series || !asked) return 0;
  const first = asked.findIndex((way) => way > AT_REST);
  return series.time[first < 0 ? series.time.length - 1 : first] ?? 0;
});

export function seek(to: number): void {
  time.value = Math.min(duration.peek(), Math.max(0, to));
}

export function togglePlay(): void {
  if (duration.peek() <= 0) return;
  if (!playing.peek() && time.peek() >= duration.peek() - 1e-6) time.value = 0;
  playing.value = !playing.peek();
}

/** To the next or the previous key pose. */
export function stepKey(direction: 1 | -1): void {
  const times = keyTimes.peek();
  const now = time.peek();
  const next =
    direction > 0 ? times.find((t) => t > now + 1e-3) : times.findLast((t) => t < now - 1e-3);
  playing.value = false;
  seek(next ?? (direction > 0 ? duration.peek() : 0));
}

/** A slow machine drops frames and stays on time; a page that was hidden does not leap [s]. */
const LONGEST_FRAME = 1;

const still = matchMedia("(prefers-reduced-motion: reduce)");

/** A rollout that came at once, out of the store, was not seen being driven: it plays. */
function playStored(): void {
  let seen = false;
  let before = run.peek();
  effect(() => {
    seen ||= live.value !== null;
    const now = run.value;
    if (now === before) return;
    before = now;
    if (now && !seen && !still.matches && activity.peek() === "running") {
      time.value = 0;
      playing.value = true;
    }
    if (now) seen = false;
  });
}

export function startClock(): void {
  let last = 0;
  const tick = (now: number) => {
    if (!playing.peek()) return;
    const dt = Math.min(LONGEST_FRAME, (now - last) / 1000);
    last = now;
    const next = time.peek() + dt * speed.peek();
    time.value = Math.min(next, duration.peek());
    if (next >= duration.peek()) playing.value = false;
    else requestAnimationFrame(tick);
  };
  effect(() => {
    if (!playing.value) return;
    last = performance.now();
    requestAnimationFrame(tick);
  });
  // An infeasible plan shows where it stops; once it is feasible again, the clock goes back.
  let before: number | null = null;
  effect(() => {
    const stopped = plan.value?.status === "infeasible";
    if (stopped && before === null) {
      before = time.peek();
      playing.value = false;
      time.value = Number.MAX_VALUE;
    } else if (plan.value && !stopped && before !== null) {
      time.value = before;
      before = null;
    }
  });
  // A running rollout takes the clock along: the robot is where it has got to.
  let along = false;
  effect(() => {
    const running = live.value !== null;
    if (!shownRun.value || !(running || along)) return;
    // The finished rollout is a little longer than what it had sent of itself.
    along = running;
    playing.value = false;
    time.value = duration.value;
  });
  playStored();
  // A new plan may be shorter than the clock stands.
  effect(() => {
    if (time.value > duration.value) time.value = duration.value;
  });
}
