/** Saving, deleting, reading and writing robots. */

import { batch, signal } from "@preact/signals";
import { deleteRobot, importRobot, putRobot, reasonOf, robotFile } from "../api/client";
import type { ImportedRobot, RobotDocument } from "../api/types";
import { readRobots } from "../state/catalogue";
import { report } from "../state/connection";
import { commitChoices } from "../state/drawing";
import {
  allRobots,
  asDocument,
  robotDocument,
  robotEdits,
  robotName,
  robots,
  sentRobot,
} from "../state/setup";
import { toast } from "../state/toast";
import { choose, imports } from "./edit";

/** What went wrong with a name or a file, where it happened. */
export const shelfError = signal<string | null>(null);

/** A file that was read, refused, or is being read. */
export interface Reading {
  file: File;
  /** Joints that count as rigid, as they were typed. */
  hold: string;
  imported: ImportedRobot | null;
  refused: string | null;
}
export const reading = signal<Reading | null>(null);
let newest: AbortController | null = null;

function fail(error: unknown): void {
  report(error);
  shelfError.value = reasonOf(error);
}

function without(name: string) {
  const { [name]: _, ...others } = robotEdits.peek();
  return others;
}

/** Save the robot in hand under a name; it is the one in hand then. */
export async function saveAs(name: string): Promise<boolean> {
  const now = robotDocument.peek();
  if (!now) return false;
  const before = robotName.peek();
  try {
    await putRobot({ ...sentRobot(now), name });
    await readRobots();
    batch(() => {
      robotEdits.value = without(before);
      choose(name);
      shelfError.value = null;
    });
    commitChoices();
    return true;
  } catch (error) {
    fail(error);
    return false;
  }
}

export async function remove(robot: RobotDocument): Promise<void> {
  const edited = robotEdits.peek()[robot.name];
  try {
    await deleteRobot(robot.name);
    batch(() => {
      robotEdits.value = without(robot.name);
      if (robotName.peek() === robot.name) choose(robots.peek()[0]?.name ?? "");
    });
    await readRobots();
    toast.value = { text: `${robot.name} is deleted.`, undo: () => void putBack(robot, edited) };
  } catch (error) {
    fail(error);
  }
}

async function putBack(robot: RobotDocument, edited: RobotDocument | undefined): Promise<void> {
  try {
    await putRobot(sentRobot(robot));
    await readRobots();
    if (edited) robotEdits.value = { ...robotEdits.peek(), [robot.name]: edited };
    choose(robot.name);
  } catch (error) {
    fail(error);
  }
}

/** Forget a robot that was read from a file and never saved. */
export function dismiss(name: string): void {
  const { [name]: _, ...others } = imports.peek();
  batch(() => {
    imports.value = others;
    robotEdits.value = without(name);
    if (robotName.peek() === name) choose(robots.peek()[0]?.name ?? "");
  });
}

/** Read a file of another tool's; nothing changes until it is opened. */
export async function readFile(file: File, hold = ""): Promise<void> {
  newest?.abort();
  const abort = new AbortController();
  newest = abort;
  reading.value = { file, hold, imported: null, refused: null };
  const joints = hold.split(",").map((text) => text.trim());
  try {
    const imported = await importRobot(file, joints.filter(Boolean), abort.signal);
    if (newest === abort) reading.value = { file, hold, imported, refused: null };
  } catch (error) {
    report(error);
    if (newest === abort) {
      const refused = reasonOf(error).replace(/^file: /, "");
      reading.value = { file, hold, imported: null, refused };
    }
  }
}

export function stopReading(): void {
  newest?.abort();
  newest = null;
  reading.value = null;
}

/** A name that no robot has yet. */
function free(name: string): string {
  let tried = name;
  for (let i = 2; allRobots.peek().some((r) => r.name === tried); i++) tried = `${name} ${i}`;
  return tried;
}

/** Take the robot that was read into the hand. */
export function openRead(): void {
  const imported = reading.peek()?.imported;
  if (!imported) return;
  const name = free(imported.robot.name);
  const robot = { ...imported.robot, name };
  batch(() => {
    imports.value = { ...imports.peek(), [name]: { ...imported, robot } };
    robotEdits.value = { ...robotEdits.peek(), [name]: asDocument(robot) };
    reading.value = null;
    choose(name);
  });
  commitChoices();
}

const ENDINGS: Record<string, string> = { mjcf: "xml" };

export async function download(format: string): Promise<void> {
  const now = robotDocument.peek();
  if (!now) return;
  try {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(await robotFile(sentRobot(now), format));
    link.download = `${now.name}.${ENDINGS[format] ?? format}`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
  } catch (error) {
    fail(error);
    toast.value = { text: `No ${format.toUpperCase()}: ${reasonOf(error)}` };
  }
}
