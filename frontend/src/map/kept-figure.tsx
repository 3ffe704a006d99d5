/** The kept cell as a picture: the robot on its stairs where the least margin is, or where it ends. */

import { useEffect, useState } from "preact/hooks";
import { postPlan } from "../api/client";
import type { Plan, PlanRequest, TerrainDocument, Vec2 } from "../api/types";
import { type RobotShape, robotShape, skeleton } from "../geometry/robot";
import { Figure } from "../profile-editor/figure";
import type { Projection } from "../profile-editor/viewport";
import { report } from "../state/connection";
import { study } from "./state";
import { getCell } from "./studies";

export interface Shown {
  plan: Plan;
  robot: RobotShape;
  points: readonly Vec2[];
}

const WIDTH = 276;
const HEIGHT = 168;
/** Of ground left and right of the robot [m]. */
const AROUND = 0.5;

/** The cell's plan, once it is there. A cell without a question has none. */
export function useCell(cell: number): Shown | null {
  const [shown, setShown] = useState<Shown | null>(null);
  const id = study.value?.id;
  useEffect(() => {
    const abort = new AbortController();
    setShown(null);
    const read = async () => {
      if (!id || cell < 0) return;
      const { plan: question } = await getCell(id, cell);
      if (!question || abort.signal.aborted) return;
      const plan = await postPlan(question as unknown as PlanRequest, abort.signal);
      const terrain = question.terrain as TerrainDocument;
      setShown({
        plan,
        robot: robotShape(plan.robot_description),
        points: terrain.points,
      });
    };
    read().catch((error) => !abort.signal.aborted && report(error));
    return () => abort.abort();
  }, [id, cell]);
  return shown;
}

/** The pose that is told: the one that binds; of a plan that ends, the last. */
function telling(plan: Plan) {
  const { poses, binding, problem } = plan;
  if (problem || !binding) return poses[poses.length - 1];
  return poses.reduce((a, b) =>
    Math.abs(b.progress - binding.progress) < Math.abs(a.progress - binding.progress) ? b : a,
  );
}

export function KeptFigure({ shown }: { shown: Shown | null }) {
  const pose = shown && telling(shown.plan);
  if (!shown || !pose) return <div class="kept-figure" />;
  const { robot, points } = shown;
  const bones = skeleton(robot, { x: pose.x_c, z: pose.z_c, pitch: pose.pitch, q: pose.q });
  const all = [...bones.trunk, ...bones.legs.flat()];
  const [left, right] = [
    Math.min(...all.map((p) => p[0])) - AROUND,
    Math.max(...all.map((p) => p[0])) + AROUND,
  ];
  const low = Math.min(...all.map((p) => p[1])) - robot.wheel;
  const high = Math.max(...all.map((p) => p[1]));
  const scale = Math.min(WIDTH / (right - left), (HEIGHT - 30) / (high - low));
  const px = (x: number) => WIDTH / 2 + (x - (left + right) / 2) * scale;
  const py = (z: number) => HEIGHT - 14 - (z - low) * scale;
  const to: Projection = {
    px,
    py,
    scale,
    at: ([x, z]) => `${px(x).toFixed(1)},${py(z).toFixed(1)}`,
  };
  const ground = points.map(to.at).join(" ");
  const [first, last] = [points[0]!, points[points.length - 1]!];
  const floor = HEIGHT + 40;
  return (
    <svg
      class="kept-figure"
      viewBox={`0 0 ${WIDTH} ${HEIGHT}`}
      role="img"
      aria-label={
        shown.plan.problem ? "The robot where its path ends" : "The robot where its margin is least"
      }
    >
      <polygon class="soil" points={`${px(first[0])},${floor} ${ground} ${px(last[0])},${floor}`} />
      <polyline class="prof" points={ground} />
      <Figure robot={robot} bones={bones} to={to} kind="cur" />
    </svg>
  );
}
