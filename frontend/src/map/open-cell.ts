/** A cell as a plan in the editor: all that it was asked with. */

import { batch } from "@preact/signals";
import { reasonOf } from "../api/client";
import type {
  FacingChoice,
  Method,
  PlanTiming,
  SentRobot,
  SettingValues,
  TerrainDocument,
} from "../api/types";
import { fit } from "../profile-editor/viewport";
import { report } from "../state/connection";
import { open } from "../state/drawing";
import { chosenFacing, method, takeWeights, timing, tolerance } from "../state/setup";
import { takeRobot } from "../state/taken-robot";
import { toast } from "../state/toast";
import { workspace } from "../state/workspace";
import { factsAt } from "./cell";
import type { Place } from "./frame";
import { type AxisKind, axisKind } from "./quantities";
import { study } from "./state";
import { type CellAnswer, getCell } from "./studies";

interface Question {
  terrain: TerrainDocument;
  robot: SentRobot;
  friction: number;
  method: Method;
  weights: SettingValues;
  timing?: PlanTiming;
  facing?: FacingChoice;
  tolerance?: SettingValues;
}

export async function openCell(place: Place): Promise<void> {
  const facts = factsAt(place);
  const id = study.peek()?.id;
  if (!facts || !id || facts.cell < 0) return;
  try {
    const { plan, values } = await getCell(id, facts.cell);
    if (!plan) {
      toast.value = { text: "These values make no stairs, so there is nothing to open." };
      return;
    }
    const question = plan as unknown as Question;
    const changes = measures(values, ofRobot);
    const ground = measures(values, (kind) => Boolean(kind.group));
    batch(() => {
      const name = ground || question.terrain.name;
      open({ ...question.terrain, name, friction: question.friction }, null, () => {
        takeRobot({ ...question.robot, name: called(question.robot.name, changes) });
        method.value = question.method;
        takeWeights(question.method, question.weights);
        timing.value = question.timing ?? "steady";
        chosenFacing.value = question.facing ?? null;
        tolerance.value = question.tolerance ?? {};
      });
      workspace.value = "plan";
    });
    fit(question.terrain.points);
  } catch (error) {
    report(error);
    toast.value = { text: reasonOf(error) };
  }
}

const LONGEST = 60;

/** What a map has changed is another robot, whose name says how. */
const called = (name: string, changes: string) => `${name} ${changes}`.trim().slice(0, LONGEST);

const ofRobot = (kind: AxisKind) => kind.name === "payload" || kind.name.startsWith("robot.");

/** The cell's values of some axes, as a part of a name that terrains and robots may have. */
function measures(values: CellAnswer["values"], which: (kind: AxisKind) => boolean): string {
  return Object.entries(values)
    .map(([name, value]) => ({ kind: axisKind(name), value }))
    .filter(({ kind }) => which(kind))
    .map(({ kind, value }) => {
      const shown = typeof value === "number" ? value.toFixed(kind.digits) : value;
      return `${kind.title.toLowerCase()} ${shown} ${kind.unit}`.trim();
    })
    .join(" ")
    .replaceAll(/[^\w .+-]+/g, "");
}
