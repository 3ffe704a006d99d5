/** A stored result back in Plan: its terrain, robot and settings as they were. */

import { getPlan, getRollout, reasonOf } from "../api/client";
import type { Entry } from "../api/stored";
import type { Plan } from "../api/types";
import { fit } from "../profile-editor/viewport";
import { report } from "../state/connection";
import { restoreRollout } from "../state/rollouts";
import { controller, disturbance, seed } from "../state/setup";
import { robotOf, showPlan } from "../state/shown-plan";
import { toast } from "../state/toast";
import { workspace } from "../state/workspace";
import { title } from "./store";

/** Plans and rollouts as they were; a set of trials as its plan and settings. */
export async function openInPlan(entry: Entry): Promise<void> {
  const planId = entry.kind === "plans" ? entry.id : entry.summary.plan_id;
  try {
    const stored =
      entry.kind === "rollouts" ? ((await getRollout(entry.id)) as { plan?: Plan | null }) : null;
    const plan = stored?.plan ?? (await getPlan(planId ?? ""));
    const robot = await robotOf(plan);
    const { summary: s } = entry;
    showPlan(plan, robot, () => {
      if (entry.kind === "plans") return;
      controller.value = s.controller ?? {};
      seed.value = s.seed ?? 0;
      disturbance.value = s.disturbance ?? {};
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
