/** What a map is asked for: its axes and what is done about friction; and the study that asks it. */

import { signal } from "@preact/signals";
import type { FacingChoice, SentRobot } from "../api/types";
import { drawing } from "../state/drawing";
import { request } from "../state/question";
import { robotEdits, sourceOf } from "../state/setup";
import { axisKind } from "./quantities";
import type { StudyDocument } from "./studies";

export interface Range {
  name: string;
  from: number;
  to: number;
  count: number;
}

/** Friction: the page's, searched for the least that does, or some of them one after the other. */
export type Friction = "page" | "least" | "slices";

export interface Form {
  x: Range;
  y: Range;
  friction: Friction;
  slices: readonly number[];
  steps: number;
  /** Another robot to compare with. */
  second: string | null;
}

const range = (name: string): Range => {
  const [from, to, count] = axisKind(name).range;
  return { name, from, to, count };
};

const SLICES = [0.3, 0.45, 0.6, 0.8];
/** Friction is searched between this and the page's, to this tolerance. */
const LEAST_FRICTION = 0.1;
const TOLERANCE = 0.05;

const asked = (x: string, y: string): Form => ({
  x: range(x),
  y: range(y),
  friction: "page",
  slices: SLICES,
  steps: 3,
  second: null,
});

export interface Preset {
  title: string;
  note: string;
  form: Form;
}

export const PRESETS: readonly Preset[] = [
  { title: "Stairs", note: "tread × rise", form: asked("stairs.tread", "stairs.rise") },
  {
    title: "Stairs, least friction",
    note: "tread × rise, by bisection",
    form: {
      ...asked("stairs.tread", "stairs.rise"),
      x: { ...range("stairs.tread"), count: 14 },
      y: { ...range("stairs.rise"), count: 16 },
      friction: "least",
    },
  },
  { title: "Step", note: "friction × height", form: asked("friction", "step.height") },
  {
    title: "Payload",
    note: "friction × payload, on this terrain",
    form: asked("friction", "payload"),
  },
  {
    title: "Legs",
    note: "thigh × calf, on this terrain",
    form: asked("robot.thigh.length", "robot.calf.length"),
  },
];

export const form = signal<Form>(PRESETS[0]!.form);

export function change(part: Partial<Form>): void {
  form.value = { ...form.peek(), ...part };
}

/** Another quantity on an axis: with its own range; the two change places where both are one. */
export function chooseAxis(which: "x" | "y", name: string): void {
  const now = form.peek();
  const other = which === "x" ? "y" : "x";
  if (now[other].name === name) change({ x: now.y, y: now.x });
  else change({ [which]: range(name) });
}

const axesOf = (now: Form) => [now.x.name, now.y.name];

export const asksSteps = (now: Form) =>
  axesOf(now).some((name) => axisKind(name).group === "stairs") &&
  !axesOf(now).includes("stairs.steps");

export const hasFriction = (now: Form) => axesOf(now).includes("friction");

/** Which terrain is meant, in a few words. */
export function ground(now: Form): string {
  const group = axesOf(now)
    .map((name) => axisKind(name).group)
    .find(Boolean);
  if (group === "stairs")
    return asksSteps(now) ? `${now.steps} step${now.steps === 1 ? "" : "s"} up` : "stairs up";
  if (group) return `one ${group}`;
  return drawing.value.name;
}

const MANNERS: Record<FacingChoice, string> = {
  forward: ", forward",
  backward: ", backward",
  either: ", either end in front",
};

/** What the page's settings make of every plan of the map, in a few words. */
export function manner(): string {
  const { timing, facing, tolerance } = request.value ?? {};
  return [
    timing === "fast" && ", fast",
    facing && MANNERS[facing],
    tolerance && ", with the tolerance set",
  ]
    .filter(Boolean)
    .join("");
}

/** Two robots by their names, and the documents of those that are not stored as they are. */
function pairOf(first: string | SentRobot, second: string): [string[], Record<string, SentRobot>] {
  const own = typeof first === "string" ? first : first.name;
  // Beside itself it is the robot as it was before it was changed.
  const itself = own === second;
  const name = itself ? `${own} edited` : own;
  const sources = [
    [name, first],
    [second, itself ? second : sourceOf(second, robotEdits.peek())],
  ] as const;
  const documents = sources.filter(([, source]) => typeof source !== "string");
  return [[name, second], Object.fromEntries(documents) as Record<string, SentRobot>];
}

/** The study; null while the page has nothing to plan with. */
export function documentOf(now: Form): StudyDocument | null {
  const page = request.peek();
  if (!page) return null;
  const axes: StudyDocument[] = [now.x, now.y].map(({ name, from, to, count }) => ({
    name,
    from,
    to,
    count,
  }));
  const rest: StudyDocument = { friction: page.friction };
  if (now.second && now.second !== page.robot) {
    const [values, robots] = pairOf(page.robot, now.second);
    axes.push({ name: "robot", values });
    if (Object.keys(robots).length > 0) rest.robots = robots;
  }
  if (hasFriction(now)) delete rest.friction;
  else if (now.friction === "slices") {
    axes.push({ name: "friction", values: [...now.slices] });
    delete rest.friction;
  } else if (now.friction === "least" && page.friction > LEAST_FRICTION + TOLERANCE) {
    axes.push({
      name: "friction",
      boundary: [LEAST_FRICTION, page.friction],
      tolerance: TOLERANCE,
    });
    rest.diagnose = "last"; // with less friction, it is friction that is missing
    delete rest.friction;
  }
  const groups = axesOf(now).map((name) => axisKind(name).group);
  if (groups.includes("stairs")) {
    rest.terrain = { kind: "stair", rise: 0.17, run: 0.28, count: now.steps };
  } else if (!groups.some(Boolean)) rest.terrain = page.terrain;
  return {
    schema: "stairwright/study/1",
    robot: page.robot,
    method: page.method,
    ...(page.weights ? { weights: page.weights } : {}),
    ...(page.timing ? { timing: page.timing } : {}),
    ...(page.facing ? { facing: page.facing } : {}),
    ...(page.tolerance ? { tolerance: page.tolerance } : {}),
    ...rest,
    axes,
  };
}

interface Asked {
  name: string;
  values: readonly (number | string)[];
  boundary: boolean;
}

/** The form that asks what a study asked, as far as it can say it. */
export function formOf(axes: readonly Asked[], document: StudyDocument): Form {
  const now = form.peek();
  const numeric = axes.filter((axis) => !axis.boundary && typeof axis.values[0] === "number");
  const span = (axis: Asked | undefined, old: Range): Range => {
    if (!axis) return old;
    const values = axis.values as readonly number[];
    const { name } = axisKind(axis.name);
    return { name, from: values[0]!, to: values.at(-1)!, count: values.length };
  };
  const [x, y] = [span(numeric[0], now.x), span(numeric[1], now.y)];
  const friction = axes.find((axis) => axis.name === "friction");
  const sliced = friction && numeric.indexOf(friction) > 1;
  const terrain = document.terrain as { count?: number } | undefined;
  const robots = axes.find((axis) => axis.name === "robot")?.values;
  return {
    x,
    y,
    friction: friction?.boundary ? "least" : sliced ? "slices" : "page",
    slices: sliced ? (friction.values as number[]) : now.slices,
    steps: terrain?.count ?? now.steps,
    second: robots?.length === 2 ? String(robots[1]) : null,
  };
}
