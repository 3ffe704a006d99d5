/** A small picture of the terrain, with the robot where its margin is least, or where it failed. */

import type { Summary } from "../api/stored";
import type { Vec2 } from "../api/types";
import { robotShape, skeleton, turned } from "../geometry/robot";
import { robots } from "../state/setup";

const WIDTH = 88;
const HEIGHT = 46;
const PAD = 4;
/** How much of the terrain is shown before and behind the robot [m]. */
const AROUND = 0.7;

/** The outline between two places along x; upright faces stay upright. */
function cut(outline: readonly Vec2[], from: number, to: number): Vec2[] {
  const found: Vec2[] = [];
  for (let i = 0; i + 1 < outline.length; i++) {
    const [a, b] = [outline[i]!, outline[i + 1]!];
    if (Math.max(a[0], b[0]) < from || Math.min(a[0], b[0]) > to) continue;
    const run = b[0] - a[0];
    const at = (x: number): Vec2 =>
      Math.abs(run) < 1e-9 ? [a[0], a[1]] : [x, a[1] + ((b[1] - a[1]) * (x - a[0])) / run];
    if (found.length === 0) found.push(a[0] < from ? at(from) : a);
    found.push(b[0] > to ? at(to) : b);
  }
  return found;
}

export function Thumbnail({ summary, bad }: { summary: Summary; bad: boolean }) {
  const { outline: whole, pose } = summary;
  const outline = whole && pose ? cut(whole, pose.x - AROUND, pose.x + AROUND) : (whole ?? []);
  if (outline.length < 2) return <span class="thumb" />;
  const file = robots.value.find((each) => each.name === summary.robot);
  const built = file && robotShape(file);
  const shape = built && summary.facing === "backward" ? turned(built) : built;
  const bones = pose && shape ? skeleton(shape, pose) : null;
  const body = bones ? [...bones.trunk, ...bones.legs.flat()] : [];
  const xs = [...outline, ...body].map((p) => p[0]);
  const zs = [...outline, ...body].map((p) => p[1]);
  const [x0, x1, z0, z1] = [Math.min(...xs), Math.max(...xs), Math.min(...zs), Math.max(...zs)];
  const scale = Math.min(
    (WIDTH - 2 * PAD) / Math.max(x1 - x0, 0.1),
    (HEIGHT - 2 * PAD) / Math.max(z1 - z0, 0.1),
  );
  const left = (WIDTH - scale * (x1 - x0)) / 2;
  const at = ([x, z]: Vec2) =>
    `${(left + (x - x0) * scale).toFixed(1)},${(HEIGHT - PAD - (z - z0) * scale).toFixed(1)}`;
  const ground = outline.map(at).join(" ");
  return (
    <svg class={bad ? "thumb bad" : "thumb"} viewBox={`0 0 ${WIDTH} ${HEIGHT}`} aria-hidden="true">
      <polygon
        class="ground"
        points={`${at([outline[0]![0], z0])} ${ground} ${at([outline.at(-1)![0], z0])}`}
      />
      <polyline class="profile" points={ground} />
      {bones &&
        shape &&
        bones.legs.map((leg, i) => {
          const [cx, cy] = at(leg[2]!).split(",");
          return (
            <g key={i === 0 ? "front" : "rear"} class={i === 0 ? "front" : "rear"}>
              <polyline points={leg.map(at).join(" ")} />
              <circle cx={cx} cy={cy} r={Math.max(1.5, shape.wheel * scale)} />
            </g>
          );
        })}
      {bones && <polygon class="trunk" points={bones.trunk.map(at).join(" ")} />}
    </svg>
  );
}
