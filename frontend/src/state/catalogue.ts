/** What is stored by now: another window may have saved or deleted something. */

import { batch } from "@preact/signals";
import { getRobots, getTerrains } from "../api/client";
import { inOrder } from "../api/in-order";
import { robotEdits, robots, storedRobot, terrains } from "./setup";
import { takeRobot } from "./taken-robot";

export const readTerrains = inOrder(getTerrains, (all) => {
  terrains.value = all;
});

/** A robot in hand that is stored no longer stays there, as one that is not saved. */
export const readRobots = inOrder(getRobots, (all) => {
  const held = storedRobot.peek();
  const lost = held && !all.some((each) => each.name === held.name);
  batch(() => {
    robots.value = all;
    if (lost) takeRobot(robotEdits.peek()[held.name] ?? held);
  });
});
