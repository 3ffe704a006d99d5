/** A design in the Robot workspace, as one that was read and is not saved yet. */

import { batch } from "@preact/signals";
import { choose, imports } from "../robot/edit";
import { commitChoices } from "../state/drawing";
import { asDocument, robotEdits } from "../state/setup";
import { toast } from "../state/toast";
import { workspace } from "../state/workspace";
import { search } from "./state";

export function openDesign(number: number): void {
  const candidate = search.peek()?.candidates[number];
  if (!candidate?.robot) {
    toast.value = { text: "Only designs of the front are kept with their robots." };
    return;
  }
  const name = `${candidate.robot.name} design ${number + 1}`;
  const robot = { ...candidate.robot, name };
  batch(() => {
    imports.value = {
      ...imports.peek(),
      [name]: { robot, assumed: [], warnings: [], joints: {}, locked: {} },
    };
    robotEdits.value = { ...robotEdits.peek(), [name]: asDocument(robot) };
    choose(name);
    workspace.value = "robot";
  });
  commitChoices();
  toast.value = { text: `${name} is open. Save it to keep it.` };
}
