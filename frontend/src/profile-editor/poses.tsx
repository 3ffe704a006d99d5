/** The robot on the canvas: ghosts of the plan, key poses, the pose at the clock, B dashed. */

import { computed } from "@preact/signals";
import { hasFailed, type Plan, type Vec2 } from "../api/types";
import { planFrame, runFrame } from "../geometry/frames";
import { type Frame, nearestPart, type Part, type RobotShape, skeleton } from "../geometry/robot";
import { ghost } from "../state/effect";
import { plan, planB, planKept, preview, robot, robotOf } from "../state/planning";
import { duration, frame, poseIndex, shownRun, shownTime } from "../state/playback";
import { runB } from "../state/rollouts";
import { layers } from "../state/view";
import { workspace } from "../state/workspace";
import { collisionPoints, Details, Figure } from "./figure";
import { type Projection, projection } from "./viewport";

/** At most this many ghosts between the key poses. */
const GHOSTS = 14;
/** Key poses nearer to each other than this are drawn as one [m]. */
const APART = 0.06;

function poseFrame(shown: Plan, i: number): Frame | null {
  const pose = shown.poses[i];
  return pose ? { x: pose.x_c, z: pose.z_c, pitch: pose.pitch, q: pose.q } : null;
}

/** Indices of poses evenly apart in progress, without the key ones. */
const ghostIndices = computed<number[]>(() => {
  const shown = plan.value;
  if (!shown || shown.poses.length <= shown.critical.length) return [];
  const end = shown.poses[shown.poses.length - 1]!.progress;
  const out: number[] = [];
  let next = 0;
  for (let k = 0; k < GHOSTS; k++) {
    const wish = ((k + 0.5) / GHOSTS) * end;
    while (next < shown.poses.length - 1 && shown.poses[next]!.progress < wish) next++;
    if (!shown.critical.includes(next)) out.push(next);
  }
  return [...new Set(out)];
});

/** Whose key poses are drawn: those for what is on screen now, before a path through them. */
export const keyed = computed(() =>
  // While another workspace hides the canvas, nothing on it has to follow the hand.
  workspace.value === "plan" ? (preview.value ?? plan.value) : null,
);

/** Key poses that stand apart; of a cluster the first is drawn. */
export const keyIndices = computed<number[]>(() => {
  const shown = keyed.value;
  if (!shown) return [];
  const out: number[] = [];
  // Of the paper's plan also the pose it starts and the one it ends with.
  const all = shown.method === "critical" ? shown.poses.map((_, i) => i) : shown.critical;
  for (const i of all) {
    const last = out[out.length - 1];
    const here = shown.poses[i];
    const there = last === undefined ? undefined : shown.poses[last];
    if (!here) continue;
    if (!there || Math.hypot(here.x_c - there.x_c, here.z_c - there.z_c) > APART) out.push(i);
  }
  return out;
});

export function Ghosts() {
  return (
    <>
      <Between />
      <Keys />
    </>
  );
}

interface FiguresProps {
  shown: Plan;
  shape: RobotShape;
  indices: number[];
  kind: "ghost" | "key";
}

function Figures({ shown, shape, indices, kind }: FiguresProps) {
  const to = projection.value;
  return (
    <g>
      {indices.map((i, k) => {
        const f = poseFrame(shown, i);
        // Pooled by place in the list: a new plan moves the figures instead of replacing them.
        return f && <Figure key={k} robot={shape} bones={skeleton(shape, f)} to={to} kind={kind} />;
      })}
    </g>
  );
}

/** What only a path tells: the poses between the key ones and the centre of mass's way. */
function Between() {
  const shown = plan.value;
  const shape = robot.value;
  if (!shown || !shape || !planKept.value) return null;
  const { at } = projection.value;
  return (
    <g>
      {layers.value.has("com") && (
        <polyline class="comp" points={shown.poses.map((p) => at(p.com)).join(" ")} />
      )}
      {layers.value.has("ghosts") && (
        <Figures shown={shown} shape={shape} indices={ghostIndices.value} kind="ghost" />
      )}
    </g>
  );
}

function Keys() {
  const shown = keyed.value;
  const shape = robotOf(shown);
  if (!shown || !shape || !layers.value.has("keys")) return null;
  return (
    <g>
      <Figures shown={shown} shape={shape} indices={keyIndices.value} kind="key" />
    </g>
  );
}

/** What stops the robot is painted red on the last pose. */
const badPart = computed<Part | null>(() => {
  const shown = plan.value;
  const shape = robot.value;
  const now = frame.value;
  if (!shown?.problem || !shape || !now || shown.problem.kind !== "clearance") return null;
  if (poseIndex.value < shown.poses.length - 1) return null;
  return nearestPart(skeleton(shape, now), shown.problem.at);
});

export function Current() {
  const shape = robot.value;
  const now = frame.value;
  if (!shape || !now || !planKept.value) return null;
  const to = projection.value;
  const bones = skeleton(shape, now);
  const pose = plan.value?.poses[poseIndex.value];
  const points = layers.value.has("collision") ? collisionPoints(shape, bones) : null;
  const rollout = shownRun.value;
  const fallen = hasFailed(rollout) && shownTime.value >= duration.value - 0.05;
  return (
    <g class={fallen ? "fallen" : ""}>
      <Figure robot={shape} bones={bones} to={to} kind="halo" />
      <Default />
      <Other />
      <Figure robot={shape} bones={bones} to={to} kind="cur" bad={badPart.value} />
      <Details robot={shape} bones={bones} to={to} shown={points} />
      {pose && !rollout && layers.value.has("com") && <CentreOfMass at={pose.com} to={to} />}
    </g>
  );
}

function CentreOfMass({ at, to }: { at: Vec2; to: Projection }) {
  const [x, y] = [to.px(at[0]), to.py(at[1])];
  return (
    <g class="comm" transform={`translate(${x.toFixed(1)} ${y.toFixed(1)})`}>
      <circle r={4.5} />
      <path d="M-4.5 0A4.5 4.5 0 0 1 0 -4.5V0ZM4.5 0A4.5 4.5 0 0 1 0 4.5V0Z" />
    </g>
  );
}

/** With changed weights: the default's path, and its robot at the cursor's progress, dashed. */
function Default() {
  const other = ghost.value;
  const shape = robotOf(other);
  const here = plan.value?.poses[poseIndex.value];
  if (!other?.poses.length || !shape || !here) return null;
  const { at } = projection.value;
  const next = other.poses.findIndex((pose) => pose.progress >= here.progress);
  const f = poseFrame(other, next < 0 ? other.poses.length - 1 : next);
  return (
    <>
      <polyline class="default-path" points={other.poses.map((p) => at(p.com)).join(" ")} />
      {f && <Figure robot={shape} bones={skeleton(shape, f)} to={projection.value} kind="cmp" />}
    </>
  );
}

/** B at the same time: where it cannot go on, it stays behind. */
function Other() {
  const shown = planB.value;
  const shape = robotOf(shown);
  if (!shown || !shape) return null;
  const driven = shownRun.value ? runB.value : null;
  const f = driven ? runFrame(driven, shownTime.value) : planFrame(shown, shownTime.value);
  return f && <Figure robot={shape} bones={skeleton(shape, f)} to={projection.value} kind="cmp" />;
}
