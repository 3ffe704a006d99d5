/** The robot from the side: its outline to scale, and every dimension where a hand can pull it. */

import type { Vec2 } from "../api/types";
import { collisionPoints, Details, Figure } from "../profile-editor/figure";
import { robotAsBuilt, robotDocument } from "../state/setup";
import { useMeasured } from "../ui/measured";
import { Ranges } from "./captions";
import { type Dimension, dimensions, type Label } from "./dimensions";
import { hold, letGo, pull } from "./drag";
import { selected } from "./edit";
import { Handle, placeIn, TARGET, told } from "./handle";
import { Joints } from "./joints";
import { quantityOf } from "./quantities";
import { reachOutlines } from "./reach";
import { bones, frame, projection, shown, size } from "./view";

export function SideView() {
  const box = useMeasured((element) => {
    size.value = { width: element.clientWidth, height: element.clientHeight };
  });
  return (
    <div class="side-view" ref={box}>
      <svg
        class="side"
        width={size.value.width}
        height={size.value.height}
        aria-label="The robot from the side"
        role="group"
        onPointerMove={(event) => pull(placeIn(event), event.altKey)}
        onPointerUp={letGo}
        onLostPointerCapture={letGo}
      >
        {size.value.width > 0 && <Drawing />}
      </svg>
      <Ranges />
    </div>
  );
}

function Drawing() {
  const shape = robotAsBuilt.value;
  const file = robotDocument.value;
  const pose = bones.value;
  if (!shape || !file || !pose) return null;
  const to = projection.value;
  const layers = shown.value;
  return (
    <>
      <Floor />
      {layers.has("reach") && <Reach />}
      <Figure robot={shape} bones={pose} to={to} kind="cur" />
      <Details
        robot={shape}
        bones={pose}
        to={to}
        shown={layers.has("points") ? collisionPoints(shape, pose) : null}
      />
      {layers.has("joints") && <Joints />}
      {layers.has("dimensions") && (
        <>
          {[...dimensions(file, pose, to, size.value.width, captionOf(massCentre()))]
            .sort((a, b) => Number(a.id === selected.value) - Number(b.id === selected.value))
            .map((each) => (
              <Line key={each.id} of={each} />
            ))}
          <Load />
          <MassCentre />
        </>
      )}
    </>
  );
}

function Floor() {
  const y = projection.value.py(0);
  const { width, height } = size.value;
  return (
    <>
      <rect class="below" x={0} y={y} width={width} height={Math.max(0, height - y)} />
      <path class="prof" d={`M0 ${y}H${width}`} />
    </>
  );
}

/** One tint a leg. */
function Reach() {
  const shape = robotAsBuilt.value!;
  const file = robotDocument.value!;
  const at = frame.value!;
  const to = projection.value;
  return (
    <>
      {([1, 0] as const).map((end) => (
        <path
          key={end}
          class={`reach ${end === 0 ? "f" : "r"}`}
          d={reachOutlines(shape.legs[end], file.joints[end === 0 ? "front" : "rear"])
            .map((line) => `M${line.map(([x, z]) => to.at([at.x + x, at.z + z])).join("L")}Z`)
            .join("")}
        />
      ))}
    </>
  );
}

function Line({ of }: { of: Dimension }) {
  const { from, to, aside } = of;
  const [ax, ay] = [from[0] + aside[0], from[1] + aside[1]];
  const [bx, by] = [to[0] + aside[0], to[1] + aside[1]];
  const [x, y] = of.label;
  const [wide, tall] = of.size;
  return (
    <Handle
      id={of.id}
      class="dimension"
      onHold={(at) => hold([{ id: of.id, direction: of.pull, gain: of.gain }], at)}
    >
      <path class="ext" d={`M${from}L${[ax, ay]}M${to}L${[bx, by]}`} />
      <path class="hit" d={`M${[ax, ay]}L${[bx, by]}`} />
      <path class="measure" d={`M${[ax, ay]}L${[bx, by]}`} />
      <circle class="hit" cx={bx} cy={by} r={TARGET / 2} />
      <circle class="end" cx={ax} cy={ay} r={3} />
      <circle class="end grip" cx={bx} cy={by} r={4.5} />
      <rect class="hit" x={x - wide / 2} y={y - TARGET / 2} width={wide} height={TARGET} />
      <rect class="plate" x={x - wide / 2} y={y - tall / 2} width={wide} height={tall} rx={4} />
      <text x={x} y={y + 4} text-anchor="middle">
        {of.text}
      </text>
    </Handle>
  );
}

const ACROSS: Vec2 = [1, 0];
const UP: Vec2 = [0, -1];

/** Of the trunk, on screen [px]. */
function massCentre(): Vec2 {
  const com = robotDocument.value!.trunk.com ?? [0, 0, 0];
  const at = frame.value!;
  const to = projection.value;
  return [to.px(at.x + com[0]!), to.py(at.z + com[2]!)];
}

/** Baseline of its caption below it [px]. */
const BASELINE = 22;

const CAPTION: Vec2 = [66, 14];

/** Where the caption is, inside the drawing; its letters stand on the baseline. */
function captionOf([x, y]: Vec2): Label {
  const half = CAPTION[0] / 2 + 4;
  const within = Math.min(Math.max(x, half), size.value.width - half);
  return { label: [within, y + BASELINE - 4], size: CAPTION };
}

/** To be pulled both ways. */
function MassCentre() {
  const [x, y] = massCentre();
  const pulls = [
    { id: "com.x", direction: ACROSS, gain: 1 },
    { id: "com.z", direction: UP, gain: 1 },
  ];
  return (
    <Handle id="com.x" class="centre" onHold={(from) => hold(pulls, from)}>
      <circle class="hit" cx={x} cy={y} r={14} />
      <g transform={`translate(${x} ${y}) scale(1.7)`} class="comm">
        <circle r={4.5} />
        <path d="M-4.5 0A4.5 4.5 0 0 1 0 -4.5V0ZM4.5 0A4.5 4.5 0 0 1 0 4.5V0Z" />
      </g>
      <text x={captionOf([x, y]).label[0]} y={y + BASELINE} text-anchor="middle">
        CoM {told(quantityOf("com.x"), robotDocument.value!.trunk.com?.[0] ?? 0)}
      </text>
    </Handle>
  );
}

function Load() {
  const payload = robotDocument.value!.payload;
  const at = frame.value!;
  if (!payload) return null;
  const to = projection.value;
  const [x, z] = payload.place ?? [0, 0];
  const pulls = [
    { id: "payload.x", direction: ACROSS, gain: 1 },
    { id: "payload.z", direction: UP, gain: 1 },
  ];
  const [px, py] = [to.px(at.x + x!), to.py(at.z + z!)];
  return (
    <Handle id="payload.x" class="centre" onHold={(from) => hold(pulls, from)}>
      <rect class="hit" x={px - 30} y={py - 10} width={60} height={20} />
      <text x={px} y={py + 4} text-anchor="middle">
        payload {told(quantityOf("payload.mass"), payload.mass)}
      </text>
    </Handle>
  );
}
