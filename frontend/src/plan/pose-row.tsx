/** The pose at the cursor in numbers, with a button that copies them. */

import { degrees, fixed } from "../geometry/format";
import { interpolate, planFrame, poseTimes } from "../geometry/frames";
import { CLASS_NAMES, MARGINS } from "../profile-editor/margins";
import { polite } from "../state/announce";
import { plan, planKept } from "../state/planning";
import { frame, poseIndex, shownRun, shownTime } from "../state/playback";
import { toast } from "../state/toast";
import { PlotMenu } from "../transport/plot-menu";
import { IconButton } from "../ui/icon-button";

const LEGS = ["front", "rear"] as const;

/** Normal force of a pair of wheels [N]: measured, or static where there is only a plan. */
function force(pair: number): number {
  const series = shownRun.value?.series;
  const t = shownTime.value;
  if (series) {
    const forces = series.contact_force;
    if (!forces) return Number.NaN;
    const sums = forces.map((f) => f[2 * pair]![1]! + f[2 * pair + 1]![1]!);
    return interpolate(series.time, sums, t);
  }
  const shown = plan.value;
  if (!shown?.poses.length) return Number.NaN;
  return interpolate(
    poseTimes(shown),
    shown.poses.map((pose) => pose.forces?.[pair]?.[1] ?? Number.NaN),
    t,
  );
}

interface Legged {
  thigh: string;
  calf: string;
  force: string;
}

function legs(q: readonly number[]): Legged[] {
  return LEGS.map((_, k) => ({
    thigh: `${fixed(degrees(q[2 * k]!), 1)}°`,
    calf: `${fixed(degrees(q[2 * k + 1]!), 1)}°`,
    force: fixed(force(k), 0),
  }));
}

/** Everything that the row and the margins tell, in one line of text. */
function asText(): string {
  const now = frame.peek();
  if (!now) return "";
  const parts = [
    `t ${fixed(shownTime.peek(), 2)} s`,
    `x ${fixed(now.x, 3)} m`,
    `z ${fixed(now.z, 3)} m`,
    `nose-up ${fixed(-degrees(now.pitch), 1)}°`,
    ...legs(now.q).flatMap((leg, k) => [
      `${LEGS[k]} thigh ${leg.thigh}`,
      `${LEGS[k]} calf ${leg.calf}`,
      `${LEGS[k]} normal force ${leg.force} N`,
    ]),
  ];
  const shown = plan.peek();
  const pose = shown?.poses[poseIndex.peek()];
  if (shown && pose) {
    for (const kind of MARGINS) {
      const value = kind.read(pose.margins[kind.name], shown);
      parts.push(`${kind.title} ${value} ${kind.unit}`.trim());
    }
  }
  return parts.join(", ");
}

async function copy(): Promise<void> {
  try {
    await navigator.clipboard.writeText(asText());
    polite.value = "Pose copied";
    toast.value = { text: "Pose copied" };
  } catch {
    toast.value = { text: "The browser did not let the page copy" };
  }
}

/** With a rollout of a robot that was driven, its pose; else the plan's. */
function current() {
  return frame.value ?? (plan.value ? planFrame(plan.value, 0) : null);
}

export function PoseRow() {
  return (
    <section class="pose" aria-label="Pose at the cursor">
      <h2>Pose</h2>
      <Numbers />
      <div class="grow" />
      <span class="classes" aria-hidden="true">
        {[...CLASS_NAMES].reverse().map((name) => (
          <span key={name} class={name}>
            <i />
            {name}
          </span>
        ))}
      </span>
      <PlotMenu />
    </section>
  );
}

function Numbers() {
  const now = planKept.value ? current() : null;
  if (!now) return <span class="none">no pose yet</span>;
  return (
    <>
      <Value name="x" value={fixed(now.x, 3)} />
      <Value name="z" value={fixed(now.z, 3)} unit="m" />
      <Value name="nose-up" value={`${fixed(-degrees(now.pitch), 1)}°`} />
      {legs(now.q).map((leg, k) => (
        <span class={`leg ${LEGS[k]}`} key={LEGS[k]}>
          <i title={`${LEGS[k]} legs`} />
          <span class="sr">{LEGS[k]} legs</span>
          <Value name="thigh" value={leg.thigh} />
          <Value name="calf" value={leg.calf} />
          <Value name="force" value={leg.force} unit="N" />
        </span>
      ))}
      <IconButton action={() => void copy()} label="Copy the pose" icon="copy" off={false} />
    </>
  );
}

function Value({ name, value, unit }: { name: string; value: string; unit?: string }) {
  return (
    <span class="pv">
      {name} <b>{value}</b>
      {unit && ` ${unit}`}
    </span>
  );
}
