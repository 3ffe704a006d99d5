/** The workspaces there are, in the order of their keys. A workspace appears here when it works. */

import { mapRoom, robotRoom, runsRoom } from "./parts";
import { type Workspace, workspace } from "./state/workspace";
import type { Part } from "./ui/part";

interface Room {
  name: Workspace;
  title: string;
  /** Plan is there from the start. */
  part?: Part;
}

export const WORKSPACES: readonly Room[] = [
  { name: "plan", title: "Plan" },
  { name: "robot", title: "Robot", part: robotRoom },
  { name: "map", title: "Map", part: mapRoom },
  { name: "runs", title: "Runs", part: runsRoom },
];

/** The one that is open; Plan where the address names one that is not there. */
export const openRoom = (): Room =>
  WORKSPACES.find((w) => w.name === workspace.value) ?? WORKSPACES[0]!;

/** The workspace of a number key. */
export function openByKey(key: string): boolean {
  const room = /^[1-9]$/.test(key) && WORKSPACES[Number(key) - 1];
  if (room) workspace.value = room.name;
  return Boolean(room);
}
