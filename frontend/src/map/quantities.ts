/** What may vary along an axis of a map, and what its cells may be coloured by. */

export interface AxisKind {
  /** As the study calls it. */
  name: string;
  title: string;
  unit: string;
  digits: number;
  /** First, last, number of values. */
  range: readonly [number, number, number];
  /** What may be typed. */
  limits: readonly [number, number];
  /** Which terrain it measures; none: any. */
  group?: "stairs" | "step" | "ramp";
}

const axis = (
  name: string,
  title: string,
  unit: string,
  digits: number,
  range: AxisKind["range"],
  limits: AxisKind["limits"],
): AxisKind => {
  const head = name.split(".")[0]!;
  const group = head === "stairs" || head === "step" || head === "ramp" ? { group: head } : {};
  return { name, title, unit, digits, range, limits, ...group } as AxisKind;
};

export const AXES: readonly AxisKind[] = [
  axis("stairs.tread", "Tread", "m", 2, [0.14, 0.4, 27], [0.05, 2]),
  axis("stairs.rise", "Rise", "m", 2, [0.06, 0.66, 31], [0.01, 2]),
  axis("stairs.steps", "Number of steps", "", 0, [1, 12, 12], [1, 50]),
  axis("step.height", "Step height", "m", 2, [0.04, 0.6, 29], [0.01, 2]),
  axis("ramp.slope", "Slope", "rad", 2, [0.1, 0.8, 15], [0.02, 1.5]),
  axis("ramp.rise", "Height of the ramp", "m", 2, [0.1, 1, 10], [0.01, 3]),
  axis("friction", "Friction μ", "", 2, [0.2, 0.9, 15], [0.05, 2]),
  axis("payload", "Payload", "kg", 1, [0, 20, 11], [0, 500]),
  axis("robot.thigh.length", "Thigh length", "m", 3, [0.16, 0.3, 15], [0.02, 2]),
  axis("robot.calf.length", "Calf length", "m", 3, [0.16, 0.3, 15], [0.02, 2]),
  axis("robot.wheel.radius", "Wheel radius", "m", 3, [0.03, 0.12, 10], [0.01, 1]),
  axis("robot.actuators.leg.torque", "Leg torque", "Nm", 1, [5, 40, 15], [0.1, 2000]),
];

/** Names that studies of other makers may use for the same. */
const SAME: Record<string, string> = {
  "stairs.run": "stairs.tread",
  "stairs.going": "stairs.tread",
  "stairs.height": "stairs.rise",
  "stairs.count": "stairs.steps",
  "step.rise": "step.height",
};

/** How an axis reads; one that the page does not offer reads as the study calls it. */
export function axisKind(name: string, unit = ""): AxisKind {
  const known = AXES.find((each) => each.name === (SAME[name] ?? name));
  return (
    known ?? {
      name,
      title: name,
      unit: unit === "1" ? "" : unit,
      digits: 3,
      range: [0, 1, 11],
      limits: [-1e9, 1e9],
    }
  );
}

export interface Quantity {
  /** A variable of the dataset. */
  name: string;
  title: string;
  unit: string;
  digits: number;
  /** From the dataset's unit to the one that is shown. */
  scale: number;
  /** More is harder; of margins less is. */
  rising: boolean;
}

export const LEAST = "least_friction";

export const QUANTITIES: readonly Quantity[] = [
  {
    name: LEAST,
    title: "Friction needed",
    unit: "μ",
    digits: 2,
    scale: 1,
    rising: true,
  },
  { name: "margin_com", title: "CoM margin", unit: "mm", digits: 0, scale: 1000, rising: false },
  {
    name: "margin_clearance",
    title: "Clearance",
    unit: "mm",
    digits: 0,
    scale: 1000,
    rising: false,
  },
  { name: "margin_torque", title: "Torque margin", unit: "Nm", digits: 1, scale: 1, rising: false },
  {
    name: "margin_wheel_torque",
    title: "Wheel torque margin",
    unit: "Nm",
    digits: 1,
    scale: 1,
    rising: false,
  },
  {
    name: "margin_joint_limit",
    title: "Joint margin",
    unit: "°",
    digits: 0,
    scale: 180 / Math.PI,
    rising: false,
  },
  { name: "duration", title: "Time", unit: "s", digits: 1, scale: 1, rising: true },
  { name: "speed", title: "Mean speed", unit: "m/s", digits: 2, scale: 1, rising: false },
];

export const quantityOf = (name: string): Quantity =>
  QUANTITIES.find((each) => each.name === name) ?? QUANTITIES[0]!;

/** What stops the robot: a letter and a word, as on the map. */
const REASONS: Record<string, readonly [string, string]> = {
  "": ["–", "not looked into"],
  reach: ["R", "reach"],
  clearance: ["C", "clearance"],
  joint_limit: ["J", "joint limit"],
  friction: ["F", "friction"],
  statics: ["B", "balance"],
  torque: ["T", "torque"],
  start: ["S", "start"],
  goal: ["G", "goal"],
  refused: ["–", "no such stairs"],
  failed: ["?", "not computed"],
};

export const reasonWords = (reason: string): readonly [string, string] =>
  REASONS[reason] ?? [reason.slice(0, 1).toUpperCase(), reason.replaceAll("_", " ")];

const BINDING: Record<string, string> = { com: "CoM", ...{ wheel_torque: "wheel torque" } };

export const bindingWord = (name: string): string => BINDING[name] ?? reasonWords(name)[1];
