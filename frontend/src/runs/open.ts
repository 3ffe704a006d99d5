/** A stored result back in Plan: its terrain, robot and settings as they were. */

import { batch } from "@preact/signals";
import { getPlan, getPlanRobot, getRollout, reasonOf } from "../api/client";
import type { Entry } from "../api/stored";
import type { Plan, SentRobot, SettingSchema, SettingValues } from "../api/types";
import { fit } from "../profile-editor/viewport";
import { report } from "../state/connection";
import { open } from "../state/drawing";
import { forgetRollout, restoreRollout } from "../state/rollouts";
import {
  controller,
  disturbance,
  method,
  seed,
  setFacing,
  settings,
  terrains,
  timing,
  tolerance,
  toleranceSchema,
  weights,
} from "../state/setup";
import { takeRobot } from "../state/taken-robot";
import { toast } from "../state/toast";
import { workspace } from "../state/workspace";
import { title } from "./store";

/** Those that differ from their defaults: all that the inspector holds. */
function differing(
  values: Record<string, unknown>,
  schema: Record<string, SettingSchema> = {},
): SettingValues {
  const kept = Object.entries(values).filter(
    ([name, value]) => value !== null && name in schema && schema[name]!.default !== value,
  );
  return Object.fromEntries(kept) as SettingValues;
}

function showPlan(plan: Plan, robot: SentRobot): void {
  const { terrain } = plan;
  const stored = terrains.peek().find((each) => each.name === terrain.name) ?? null;
  forgetRollout();
  open({ ...terrain, friction: plan.friction }, stored);
  takeRobot(robot);
  method.value = plan.method;
  timing.value = plan.timing.rule === "fast" ? "fast" : "steady";
  setFacing(plan.facing ?? "forward");
  const schema = settings.peek()?.weights[plan.method]?.properties;
  weights.value = { ...weights.peek(), [plan.method]: differing(plan.weights ?? {}, schema) };
  tolerance.value = differing({ ...plan.tolerance }, toleranceSchema.peek());
}

/** Plans and rollouts as they were; a set of trials as its plan and settings. */
export async function openInPlan(entry: Entry): Promise<void> {
  const planId = entry.kind === "plans" ? entry.id : entry.summary.plan_id;
  try {
    const stored =
      entry.kind === "rollouts" ? ((await getRollout(entry.id)) as { plan?: Plan | null }) : null;
    const plan = stored?.plan ?? (await getPlan(planId ?? ""));
    // Where its rear led, the plan describes it turned about.
    const robot = plan.facing === "backward" ? await getPlanRobot(plan.id) : plan.robot_description;
    const { summary: s } = entry;
    batch(() => {
      showPlan(plan, robot as SentRobot);
      if (entry.kind !== "plans") {
        controller.value = s.controller ?? {};
        seed.value = s.seed ?? 0;
        disturbance.value = s.disturbance ?? {};
      }
    });
    fit(plan.terrain.points);
    if (entry.kind === "rollouts") await restoreRollout(entry.id, null);
    workspace.value = "plan";
  } catch (error) {
    report(error);
    toast.value = {
      text: `${title(entry)} cannot be opened: ${reasonOf(error)}`,
    };
  }
}
