/** A plan that was made before, in the editor: what it was asked with. */

import { getPlanRobot } from "../api/client";
import type { Plan, SentRobot } from "../api/types";
import { open } from "./drawing";
import { forgetRollout } from "./rollouts";
import {
  differing,
  method,
  setFacing,
  takeWeights,
  timing,
  tolerance,
  toleranceSchema,
} from "./setup";
import { takeRobot } from "./taken-robot";

/** As its own file has it: where its rear led, the plan describes it turned about. */
export const robotOf = async (plan: Plan): Promise<SentRobot> =>
  plan.facing === "backward" ? await getPlanRobot(plan.id) : (plan.robot_description as SentRobot);

/**
 * Terrain, robot and settings as a plan was asked with: one step, which undo takes back.
 * @param settle changes further settings in that step
 */
export function showPlan(plan: Plan, robot: SentRobot, settle?: () => void): void {
  const { terrain } = plan;
  forgetRollout();
  open({ ...terrain, friction: plan.friction }, terrain.name, () => {
    takeRobot(robot);
    method.value = plan.method;
    timing.value = plan.timing.rule === "fast" ? "fast" : "steady";
    setFacing(plan.facing ?? "forward");
    takeWeights(plan.method, plan.weights ?? {});
    tolerance.value = differing({ ...plan.tolerance }, toleranceSchema.peek());
    settle?.();
  });
}
