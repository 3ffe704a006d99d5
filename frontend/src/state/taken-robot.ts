/** The robot of a result, taken into the hand as it was then. */

import type { SentRobot } from "../api/types";
import { asDocument, robotEdits, robotName, robots } from "./setup";

/** The stored robot where it is the same; else one of that name that is not saved. */
export function takeRobot(robot: SentRobot): void {
  const { [robot.name]: _, ...others } = robotEdits.peek();
  const stored = robots.peek().find((each) => each.name === robot.name);
  robotEdits.value =
    stored && alike(stored, robot) ? others : { ...others, [robot.name]: asDocument(robot) };
  robotName.value = robot.name;
}

/** What a service adds to a robot's file, and how old its form is, does not count. */
const BESIDES = new Set(["readonly", "version", "schema"]);

/** Whether two files say the same, in whatever order. */
function alike(a: SentRobot, b: SentRobot): boolean {
  const plain = (robot: SentRobot) =>
    JSON.stringify(robot, (key, value) => {
      if (BESIDES.has(key)) return undefined;
      if (value && typeof value === "object" && !Array.isArray(value)) {
        const entries = Object.entries(value).filter(([, v]) => v !== null);
        return Object.fromEntries(entries.sort(([x], [y]) => (x < y ? -1 : 1)));
      }
      return value;
    });
  return plain(a) === plain(b);
}
