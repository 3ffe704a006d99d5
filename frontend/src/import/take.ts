/** Profiles and plans from outside: files dropped or chosen. What is wrong is said where it was. */

import { signal } from "@preact/signals";
import { importRobot, importTerrain } from "../api/client";
import type { Method, Plan, SentRobot } from "../api/types";
import { capital } from "../geometry/format";
import { fit } from "../profile-editor/viewport";
import { report } from "../state/connection";
import { settings } from "../state/setup";
import { robotOf, showPlan } from "../state/shown-plan";
import { toast } from "../state/toast";
import { show } from "../topbar/terrain-actions";
import { startCut } from "./cut";
import { wrongWith } from "./wrong";

/** Where the user is while importing: the whole page, the terrain menu, or the table of points. */
export type Place = "page" | "menu" | "table";

/** Why nothing was imported. */
export const importProblem = signal<{ place: Place; text: string } | null>(null);

const MESH = /\.(stl|obj|ply|off)$/i;

/** A dropped or chosen file; a mesh asks for a plane first. Whether it is taken. */
export async function takeFile(file: File, place: Place): Promise<boolean> {
  importProblem.value = null;
  if (MESH.test(file.name)) {
    startCut(file);
    return true;
  }
  try {
    const made = await madeWith(file);
    if (made) await takeMade(made, file.name);
    else show(await importTerrain(file, {}), null);
    return true;
  } catch (error) {
    report(error);
    const text = `${file.name} is not imported. ${sentence(wrongWith(error))}`;
    importProblem.value = { place, text };
    return false;
  }
}

function sentence(text: string): string {
  return `${capital(text)}${text.endsWith(".") ? "" : "."}`;
}

const jsonFile = (document: unknown, name: string) =>
  new File([JSON.stringify(document)], name, { type: "application/json" });

/** What a plan or rollout of ours was made with; null for any other file. */
async function madeWith(file: File): Promise<Made | null> {
  if (!/\.json$/i.test(file.name)) return null;
  try {
    const document = JSON.parse(await file.text());
    if (!/^stairwright\/(plan|rollout)\//.test(document.schema) || !document.terrain) return null;
    const plan = document.plan ?? document;
    const whole =
      settings.peek()?.weights[plan.method as Method] && plan.robot_description && plan.timing;
    return { terrain: document.terrain, plan: whole ? plan : null };
  } catch {
    // What is wrong with it is for the service to say.
    return null;
  }
}

interface Made {
  terrain: unknown;
  /** Null where too little is told of it. */
  plan: Plan | null;
}

/** The service reads both parts, as it reads such files of their own. */
async function takeMade({ terrain, plan }: Made, name: string): Promise<void> {
  const ground = await importTerrain(jsonFile(terrain, name), {});
  const robot = plan && (await robotOf(plan).catch(() => null));
  if (!plan || !robot) {
    show(ground, null);
    if (plan)
      toast.value = {
        text: `Only the terrain of ${name} is opened: its robot went backward, and this service does not have the plan.`,
      };
    return;
  }
  const read = await importRobot(jsonFile(robot, name), []);
  showPlan({ ...plan, terrain: ground }, read.robot as SentRobot);
  fit(ground.points);
}
