/** A cell as a plan in the editor: all that it was asked with. */

import { batch } from "@preact/signals";
import { callJson, reasonOf } from "../api/client";
import type {
  FacingChoice,
  Method,
  PlanTiming,
  RobotDocument,
  SettingValues,
  TerrainDocument,
} from "../api/types";
import { fit } from "../profile-editor/viewport";
import { report } from "../state/connection";
import { open } from "../state/drawing";
import {
  chosenFacing,
  method,
  robotName,
  robots,
  settings,
  timing,
  tolerance,
  weights,
} from "../state/setup";
import { toast } from "../state/toast";
import { workspace } from "../state/workspace";
import { factsAt } from "./cell";
import type { Place } from "./frame";
import { type AxisKind, axisKind } from "./quantities";
import { study } from "./state";
import { type CellAnswer, getCell } from "./studies";

interface Question {
  terrain: TerrainDocument;
  robot: RobotDocument;
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
    const robot = await known(question.robot, measures(values, ofRobot));
    const ground = measures(values, (kind) => Boolean(kind.group));
    batch(() => {
      const name = ground || question.terrain.name;
      open({ ...question.terrain, name, friction: question.friction }, null);
      robotName.value = robot;
      method.value = question.method;
      weights.value = {
        ...weights.peek(),
        [question.method]: changed(question.method, question.weights),
      };
      timing.value = question.timing ?? "steady";
      chosenFacing.value = question.facing ?? null;
      tolerance.value = question.tolerance ?? {};
      workspace.value = "plan";
    });
    fit(question.terrain.points);
  } catch (error) {
    report(error);
    toast.value = { text: reasonOf(error) };
  }
}

const LONGEST = 60;

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

/** The page keeps only what differs from the default. */
function changed(by: Method, values: SettingValues): SettingValues {
  const schema = settings.peek()?.weights[by]?.properties ?? {};
  return Object.fromEntries(
    Object.entries(values).filter(([name, value]) => value !== schema[name]?.default),
  );
}

/** The robot's name; one that a map has changed is stored first, under a name that says how. */
async function known(robot: RobotDocument, changed: string): Promise<string> {
  const same = robots.peek().find((each) => each.name === robot.name);
  if (same && alike(same, robot)) return robot.name;
  const name = `${robot.name} ${changed}`.slice(0, LONGEST);
  const { readonly: _, ...file } = { ...robot, name } as RobotDocument & { readonly?: boolean };
  const stored = await callJson<RobotDocument>("PUT", `robots/${encodeURIComponent(name)}`, file);
  robots.value = [...robots.peek().filter((each) => each.name !== name), stored];
  toast.value = { text: `The robot is kept as ${name}.` };
  return name;
}

/** Whether two files say the same, in whatever order; what a service adds does not count. */
function alike(a: RobotDocument, b: RobotDocument): boolean {
  const plain = (robot: RobotDocument) =>
    JSON.stringify(robot, (key, value) => {
      if (key === "readonly" || key === "schema") return undefined;
      if (value && typeof value === "object" && !Array.isArray(value)) {
        const entries = Object.entries(value).filter(([, v]) => v !== null);
        return Object.fromEntries(entries.sort(([x], [y]) => (x < y ? -1 : 1)));
      }
      return value;
    });
  return plain(a) === plain(b);
}
