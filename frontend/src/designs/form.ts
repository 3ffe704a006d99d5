/** A search as the form says it: what to climb, what varies, what for; and its document. */

import { computed, signal } from "@preact/signals";
import type { ApiError } from "../api/client";
import { drawing } from "../state/drawing";
import { request } from "../state/question";
import { robotDocument, robotName } from "../state/setup";
import { type AimChoice, aimChoices, lowerFirst } from "./aims";
import { boundsRound, NUMBERS, numberOf, type Varied } from "./numbers";

/** What a design has to pass. */
export type Compute = "plan" | "rollout" | "trials";

/** Ends of a range, and for borders its fineness. */
export interface Range {
  from: number;
  to: number;
  tolerance?: number;
}

interface Form {
  compute: Compute;
  trials: number;
  /** Whether a number varies; others do as they begin. */
  varies: Readonly<Record<string, boolean>>;
  /** Bounds that were typed: of a robot's numbers as "robot name", of borders by their aim. */
  ranges: Readonly<Record<string, Range>>;
  /** Keys of the aims, one to three. */
  aims: readonly string[];
  designs: number;
}

const BEGIN = ["robot.actuators.leg.torque", "robot.actuators.calf.torque", "robot.calf.length"];
export const MOST_AIMS = 3;
export const MOST_DESIGNS = 100_000;

export const form = signal<Form>({
  compute: "plan",
  trials: 29,
  varies: {},
  ranges: {},
  aims: [],
  designs: 64,
});
/** Why the service refuses the search, with the form's own words for the field. */
export const refusal = signal<string | null>(null);

export function change(part: Partial<Form>): void {
  refusal.value = null;
  form.value = { ...form.peek(), ...part };
}

export interface Row extends Varied {
  /** As the robot has it. */
  value: number;
  on: boolean;
  range: Range;
}

/** Numbers that this robot has. */
export const rows = computed<Row[]>(() => {
  const { varies, ranges } = form.value;
  return NUMBERS.flatMap((number) => {
    const value = numberOf(robotDocument.value, number.name);
    if (value === null) return [];
    const [from, to] = boundsRound(number, value);
    const range = ranges[rangeKey(number.name)] ?? { from, to };
    return [{ ...number, value, on: varies[number.name] ?? BEGIN.includes(number.name), range }];
  });
});

const rangeKey = (name: string) => `${robotName.value} ${name}`;

export function setRange(name: string, range: Range): void {
  change({ ranges: { ...form.peek().ranges, [rangeKey(name)]: range } });
}

export function setVaries(name: string, on: boolean): void {
  change({ varies: { ...form.peek().varies, [name]: on } });
}

export const choices = computed<AimChoice[]>(() =>
  aimChoices(
    rows.value.filter((row) => row.on),
    form.value.compute !== "plan",
  ),
);

/** The aims that are chosen and can be, at least one; before any is, those of most use. */
export const aims = computed<AimChoice[]>(() => {
  const { aims: keys } = form.value;
  const motor = choices.value.find((each) => each.aim.minimise?.endsWith(".torque"));
  const wanted = keys.length > 0 ? keys : [(motor ?? choices.value[0]!).key, "more margin_com"];
  const found = wanted.flatMap((key) => choices.value.find((each) => each.key === key) ?? []);
  return found.length > 0 ? found : choices.value.slice(0, 1);
});

/** Another aim in a place; null takes the place away. */
export function chooseAim(place: number, key: string | null): void {
  const keys = aims.peek().map((each) => each.key);
  if (key === null) keys.splice(place, 1);
  else keys[place] = key;
  change({ aims: keys });
}

export const borderRange = (choice: AimChoice): Range | null =>
  choice.border ? (form.value.ranges[choice.key] ?? choice.border) : null;

export function setBorder(choice: AimChoice, range: Range): void {
  change({ ranges: { ...form.peek().ranges, [choice.key]: range } });
}

/** What an aim measures instead of the drawn terrain, if one does. */
const measured = () =>
  aims.value
    .map((each) => each.aim.maximise?.split(".")[0])
    .find((head) => head === "step" || head === "stairs");

/** Which terrain is meant, in a few words. */
export function ground(): string {
  const head = measured();
  if (!head) return drawing.value.name;
  return head === "step" ? "one step" : "stairs up";
}

/** The search; null while the page has nothing to plan with. */
export function documentOf(): Record<string, unknown> | null {
  const page = request.peek();
  if (!page) return null;
  const { compute, trials, designs } = form.peek();
  const { terrain, friction, ...rest } = page;
  const searched = aims.peek().some((each) => each.aim.minimise === "friction");
  const names = aims.peek().map((each) => lowerFirst(each.title));
  return {
    schema: "stairwright/design/1",
    name: `${robotName.peek()}: ${names.join(", ")}`.slice(0, 100),
    ask: {
      ...rest,
      axes: [],
      compute,
      diagnose: "none", // of designs that fail it is enough to know that they do
      ...(measured() ? {} : { terrain }),
      ...(searched ? {} : { friction }),
      ...(compute === "trials" ? { trials: { count: trials } } : {}),
    },
    vary: rows
      .peek()
      .filter((row) => row.on)
      .map(({ name, range }) => ({ name, between: [range.from, range.to] })),
    aims: aims.peek().map((choice) => {
      const range = borderRange(choice);
      if (!range) return choice.aim;
      const tolerance = range.tolerance ?? choice.border!.tolerance;
      return { ...choice.aim, between: [range.from, range.to], tolerance };
    }),
    designs,
  };
}

/** The service's words for what is wrong, with the form's name of the field. */
export function refused(error: ApiError): string {
  const first = error.problem.errors?.[0];
  if (!first?.field) return error.problem.detail ?? error.message;
  const [head, place] = first.field.split(".");
  const varied = rows.peek().filter((row) => row.on);
  const names: Record<string, string | undefined> = {
    vary: place === undefined ? "What varies" : varied[Number(place)]?.title,
    aims: place === undefined ? "Aims" : `Aim ${Number(place) + 1}`,
    ask: "What to climb",
    designs: "Designs",
  };
  return `${names[head!] ?? first.field}: ${first.message}`;
}
