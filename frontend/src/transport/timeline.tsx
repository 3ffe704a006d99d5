/** The clock as a slider, with the key poses on it. */

import { computed, signal } from "@preact/signals";
import { hasFailed, type Rollout } from "../api/types";
import { fixed } from "../geometry/format";
import {
  duration,
  keyTimes,
  plannedEnd,
  playing,
  seek,
  setsOff,
  shownRun,
  shownTime,
  time,
  togglePlay,
} from "../state/playback";
import { progress, running } from "../state/rollouts";
import { useMeasured } from "../ui/measured";
import { axisKind, cursor, ends, shareOf, shareOfTime, ticks, timeAt } from "./axis";

const STEP = 0.1;
const LEAP = 1;

/** Marks nearer than this would lie over each other: of a cluster the first is drawn [px]. */
const APART = 12;
/** Of the timeline [px]. */
const width = signal(0);

/** Key poses that are marked: which, and their share of the axis. */
const keyMarks = computed<[number, number][]>(() => {
  const out: [number, number][] = [];
  keyTimes.value.forEach((time, k) => {
    const share = shareOfTime(time);
    const last = out.at(-1)?.[1];
    if (last === undefined || (share - last) * width.value >= APART) out.push([k, share]);
  });
  return out;
});

export function Timeline() {
  const bar = useMeasured((element) => {
    width.value = element.clientWidth;
  });
  const end = plannedEnd.value;
  const percent = (share: number) => `${share * 100}%`;
  const growing = running.value === "a";
  const failed = hasFailed(shownRun.value);
  const at = (event: PointerEvent) => {
    const rect = (event.currentTarget as HTMLElement).getBoundingClientRect();
    playing.value = false;
    seek(timeAt((event.clientX - rect.left) / rect.width));
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const to: Record<string, number> = {
      ArrowRight: time.peek() + STEP,
      ArrowLeft: time.peek() - STEP,
      ArrowUp: time.peek() + STEP,
      ArrowDown: time.peek() - STEP,
      PageUp: time.peek() + LEAP,
      PageDown: time.peek() - LEAP,
      Home: 0,
      End: duration.peek(),
    };
    if (event.key === " ") {
      event.preventDefault();
      togglePlay();
    }
    const next = to[event.key];
    if (next === undefined) return;
    event.preventDefault();
    playing.value = false;
    seek(next);
  };
  return (
    <div
      ref={bar}
      class="scrub"
      role="slider"
      tabIndex={0}
      aria-label="Time"
      aria-valuemin={0}
      aria-valuemax={end}
      aria-valuenow={shownTime.value}
      aria-valuetext={`${fixed(shownTime.value, 2)} s of ${fixed(end, 2)} s`}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        at(event);
      }}
      onPointerMove={(event) => event.buttons === 1 && at(event)}
      onKeyDown={onKeyDown}
    >
      <Before />
      <s
        class={growing ? "buf" : failed ? "fell" : ""}
        style={{ width: percent(growing ? progress.value : cursor.value) }}
      />
      {keyMarks.value.map(([k, share]) => (
        <i key={k} style={{ left: percent(share) }} title={`Key pose ${k + 1}`} />
      ))}
      {end > 0 && <em style={{ left: percent(cursor.value) }} />}
    </div>
  );
}

/** The time in which the robot does not follow its plan yet. */
function Before() {
  const run = shownRun.value as Partial<Rollout> | null;
  if (axisKind.value !== "time" || setsOff.value <= 0) return null;
  const senses = run?.controller?.sensing === "robot";
  const does = senses ? "tests its grip" : "settles on its legs";
  return (
    <u
      style={{ width: `${shareOfTime(setsOff.value) * 100}%` }}
      title={`The robot ${does} before it sets off, ${fixed(setsOff.value, 1)} s`}
    />
  );
}

/** A number further to the right stands left of its mark. */
const LAST = 0.85;

/** Numbers under the timeline: seconds or metres. */
export function Ticks() {
  const step = (ticks.value[1] ?? 1) - (ticks.value[0] ?? 0);
  const unit = axisKind.value === "time" ? "s" : "m";
  const [from, to] = ends.value;
  if (!(to > from)) return <div class="ticks" />;
  return (
    <div class="ticks" aria-hidden="true">
      {ticks.value.map((value) => (
        <span
          key={value}
          class={shareOf(value) < LAST ? "" : "before"}
          style={{ left: `${shareOf(value) * 100}%` }}
        >
          {`${fixed(value, step < 0.1 ? 2 : step < 1 ? 1 : 0)} ${unit}`}
        </span>
      ))}
    </div>
  );
}
