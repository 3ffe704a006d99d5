/** One robot on the canvas: its lines and wheels, and the details of the pose at the clock. */

import type { Vec2 } from "../api/types";
import type { Bar, Part, RobotShape, Skeleton } from "../geometry/robot";
import type { Projection } from "./viewport";

interface FigureProps {
  robot: RobotShape;
  bones: Skeleton;
  to: Projection;
  kind: "ghost" | "key" | "cur" | "cmp" | "halo";
  bad?: Part | null;
}

/** The robot's lines at the clock are as thick as its links; elsewhere they are thin. */
const THICK = { cur: 0, halo: 6 } as const;
/** Least width of a link that is drawn as it is [px]. */
const THIN = 3;

const line = (bar: Bar, to: Projection) => `M${to.at(bar.from)}L${to.at(bar.to)}`;

const thickness = (bar: Bar, to: Projection, more: number) => ({
  strokeWidth: `${Math.max(THIN, 2 * bar.radius * to.scale) + more}px`,
});

/** Closed outlines of several pieces as one path. */
const closed = (pieces: Vec2[][], to: Projection) =>
  pieces.map((piece) => `M${piece.map(to.at).join("L")}Z`).join("");

/** Rear leg, front leg and trunk; wheels as circles. */
export function Figure({ robot, bones, to, kind, bad }: FigureProps) {
  const r = robot.wheel * to.scale;
  const more = kind === "cur" || kind === "halo" ? THICK[kind] : null;
  const leg = (i: 0 | 1, name: "f" | "r") => {
    const bars = bones.bars[i];
    const hub = bones.legs[i][2]!;
    return (
      <>
        {more === null ? (
          <path class={`leg ${name}`} d={bars.map((bar) => line(bar, to)).join("")} />
        ) : (
          bars.map((bar, k) => (
            <path
              key={k}
              class={`leg ${name}`}
              style={thickness(bar, to, more)}
              d={line(bar, to)}
            />
          ))
        )}
        <circle class={`wh ${name}`} cx={to.px(hub[0])} cy={to.py(hub[1])} r={r} />
      </>
    );
  };
  return (
    <g class={`rb ${kind}`}>
      {leg(1, "r")}
      {leg(0, "f")}
      {bones.payload && <path class="load" d={closed([bones.payload], to)} />}
      <path class={bad === "trunk" ? "tr badpart" : "tr"} d={closed(bones.outline, to)} />
      {bad && bad !== "trunk" && <BadLink bones={bones} to={to} part={bad} />}
    </g>
  );
}

function BadLink({ bones, to, part }: { bones: Skeleton; to: Projection; part: Part }) {
  const [where, link] = part.split("-");
  const bars = bones.bars[where === "front" ? 0 : 1].filter((bar) => bar.link === link);
  return (
    <>
      {bars.map((bar, k) => (
        <path key={k} class="badseg" style={thickness(bar, to, 0)} d={line(bar, to)} />
      ))}
    </>
  );
}

/** Joints, hubs, nose and collision points of the pose at the clock. */
export function Details({
  robot,
  bones,
  to,
  shown,
}: {
  robot: RobotShape;
  bones: Skeleton;
  to: Projection;
  shown: Vec2[] | null;
}) {
  const [front, rear] = bones.legs;
  const dot = (p: Vec2, cls: string, r: number) => (
    <circle class={cls} cx={to.px(p[0])} cy={to.py(p[1])} r={r} />
  );
  const trunk = bones.trunk;
  const mid = (a: Vec2, b: Vec2, f: number): Vec2 => [
    a[0] + (b[0] - a[0]) * f,
    a[1] + (b[1] - a[1]) * f,
  ];
  const inset = robot.trunk.height * 0.12;
  const nose = [
    mid(trunk[1]!, trunk[2]!, 0.3),
    mid(trunk[1]!, trunk[2]!, 0.5),
    mid(trunk[1]!, trunk[2]!, 0.7),
  ];
  const back = mid(trunk[0]!, trunk[3]!, 0.5);
  const length = Math.hypot(nose[1]![0] - back[0], nose[1]![1] - back[1]) || 1;
  const shift: Vec2 = [
    ((back[0] - nose[1]![0]) / length) * inset,
    ((back[1] - nose[1]![1]) / length) * inset,
  ];
  const chevron: Vec2[] = nose.map((p, i) => (i === 1 ? p : [p[0] + shift[0], p[1] + shift[1]]));
  return (
    <g class="rb cur">
      {dot(rear[0]!, "jt r", 3)}
      {dot(rear[1]!, "jt r", 2.5)}
      {dot(rear[2]!, "hub r", 2)}
      {dot(front[0]!, "jt f", 3)}
      {dot(front[1]!, "jt f", 2.5)}
      {dot(front[2]!, "hub f", 2)}
      <polyline class="nose" points={chevron.map(to.at).join(" ")} />
      {shown && (
        <g class="cps">
          {shown.map((p, i) => (
            <circle key={i} cx={to.px(p[0])} cy={to.py(p[1])} r={2} />
          ))}
        </g>
      )}
    </g>
  );
}

/** The collision points where the robot is now, between two poses too. */
export function collisionPoints(shape: RobotShape, bones: Skeleton): Vec2[] {
  const layout = shape.collisionPoints;
  const [a, b, , d] = bones.trunk as [Vec2, Vec2, Vec2, Vec2];
  const trunk = layout.trunk.map(
    ([u, v]): Vec2 => [
      a[0] + (b[0] - a[0]) * (u + 0.5) + (d[0] - a[0]) * (v + 0.5),
      a[1] + (b[1] - a[1]) * (u + 0.5) + (d[1] - a[1]) * (v + 0.5),
    ],
  );
  const on = (p: Vec2, q: Vec2, f: number): Vec2 => [
    p[0] + (q[0] - p[0]) * f,
    p[1] + (q[1] - p[1]) * f,
  ];
  const legs = bones.legs.flatMap(([hip, knee, wheel]) => [
    ...layout.thigh.map((f) => on(hip!, knee!, f)),
    ...layout.calf.map((f) => on(knee!, wheel!, f)),
  ]);
  return [...trunk, ...legs];
}
