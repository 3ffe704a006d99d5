/** Joint ranges as arcs at the joints: a tick at each limit, a dot at the pose. */

import type { Vec2 } from "../api/types";
import { degrees, fixed } from "../geometry/format";
import { robotDocument } from "../state/setup";
import { holdJoint, holdLimit } from "./drag";
import { Handle, placeIn, TARGET } from "./handle";
import { rangeId } from "./quantities";
import { bones, frame, projection } from "./view";

const RADIUS = { thigh: 38, calf: 30 } as const;
const TURN = 2 * Math.PI;

const on = ([x, y]: Vec2, radius: number, angle: number): Vec2 => [
  x - radius * Math.sin(angle),
  y + radius * Math.cos(angle),
];

function arc(centre: Vec2, radius: number, from: number, to: number): string {
  const span = Math.min(to - from, TURN - 1e-3);
  const [a, b] = [on(centre, radius, from), on(centre, radius, from + span)];
  const text = (p: Vec2) => `${p[0].toFixed(1)} ${p[1].toFixed(1)}`;
  return `M${text(a)}A${radius} ${radius} 0 ${span > Math.PI ? 1 : 0} 1 ${text(b)}`;
}

export function Joints() {
  return (
    <>
      {([1, 0] as const).map((end) =>
        ([0, 1] as const).map((joint) => <Range key={`${end}${joint}`} end={end} joint={joint} />),
      )}
    </>
  );
}

function Range({ end, joint }: { end: 0 | 1; joint: 0 | 1 }) {
  const file = robotDocument.value;
  const pose = frame.value;
  const place = bones.value?.legs[end][joint];
  if (!file || !pose || !place) return null;
  const to = projection.value;
  const centre: Vec2 = [to.px(place[0]), to.py(place[1])];
  const side = end === 0 ? "front" : "rear";
  const name = joint === 0 ? "thigh" : "calf";
  const range = file.joints[side][name] as Vec2;
  const index = 2 * end + joint;
  const angle = pose.q[index]!;
  // A calf's angle counts from its thigh.
  const zero = joint === 0 ? 0 : pose.q[2 * end]!;
  const radius = RADIUS[name];
  const dot = on(centre, radius, zero + angle);
  return (
    <g class={`range ${end === 0 ? "f" : "r"}`}>
      <path class="arc" d={arc(centre, radius, zero + range[0], zero + range[1])} />
      {([0, 1] as const).map((i) => {
        const id = rangeId(side, name, i);
        const [a, b] = [radius - 7, radius + 7].map((r) => on(centre, r, zero + range[i]!));
        return (
          <Handle
            key={i}
            id={id}
            class="limit"
            onHold={(from) => holdLimit(id, centre, zero, from)}
          >
            <path class="hit" d={`M${a}L${b}`} />
            <path class="tick2" d={`M${a}L${b}`} />
          </Handle>
        );
      })}
      <g
        class="pose-grip"
        onPointerDown={(event) => {
          event.currentTarget.closest("svg")!.setPointerCapture(event.pointerId);
          holdJoint(index, centre, zero, range, placeIn(event));
        }}
      >
        <title>
          {side} {name} {fixed(degrees(angle), 0)}°: drag to pose
        </title>
        <circle class="hit" cx={dot[0]} cy={dot[1]} r={TARGET / 2} />
        <circle class="pose-dot" cx={dot[0]} cy={dot[1]} r={5} />
      </g>
    </g>
  );
}
