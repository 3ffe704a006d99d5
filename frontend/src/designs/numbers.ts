/** Numbers of a robot's file that a search may vary, and the bounds that it begins with. */

import { numberAt } from "../robot/quantity";

export interface Varied {
  /** As the search calls it: the path in the robot's file. */
  name: string;
  title: string;
  unit: string;
  digits: number;
  /** Least and most that are offered, as shares of what the robot has. */
  shares: readonly [number, number];
}

const LENGTH = { unit: "m", digits: 3, shares: [0.8, 1.25] } as const;
const TORQUE = { unit: "Nm", digits: 1, shares: [0.2, 1.2] } as const;

export const NUMBERS: readonly Varied[] = [
  { name: "robot.thigh.length", title: "Thigh length", ...LENGTH },
  { name: "robot.calf.length", title: "Calf length", ...LENGTH },
  { name: "robot.rear.thigh.length", title: "Rear thigh length", ...LENGTH },
  { name: "robot.rear.calf.length", title: "Rear calf length", ...LENGTH },
  { name: "robot.wheel.radius", title: "Wheel radius", ...LENGTH, shares: [0.7, 1.5] },
  { name: "robot.actuators.leg.torque", title: "Leg torque", ...TORQUE },
  { name: "robot.actuators.thigh.torque", title: "Thigh torque", ...TORQUE },
  { name: "robot.actuators.calf.torque", title: "Calf torque", ...TORQUE },
  { name: "robot.actuators.wheel.torque", title: "Wheel torque", ...TORQUE },
  { name: "robot.trunk.mass", title: "Trunk mass", unit: "kg", digits: 2, shares: [0.7, 1.3] },
];

/** A number of a robot's file by its name, such as `robot.calf.length`. */
export const numberOf = (robot: unknown, name: string): number | null =>
  numberAt(robot, name.replace(/^robot\./, ""));

/** Bounds round the robot's own number, as they are shown. */
export function boundsRound(number: Varied, value: number): [number, number] {
  const [low, high] = number.shares;
  return [low, high].map((share) => Number((share * value).toFixed(number.digits))) as [
    number,
    number,
  ];
}
