/** The workspaces there are, in the order of their keys. A workspace appears here when it works. */

import type { ComponentType } from "preact";
import { MapRoom } from "./map/map";
import { Plan } from "./plan/plan";
import { RobotRoom } from "./robot/room";
import { Runs } from "./runs/runs";
import { type Workspace, workspace } from "./state/workspace";

interface Room {
  name: Workspace;
  title: string;
  room: ComponentType;
}

export const WORKSPACES: readonly Room[] = [
  { name: "plan", title: "Plan", room: Plan },
  { name: "robot", title: "Robot", room: RobotRoom },
  { name: "map", title: "Map", room: MapRoom },
  { name: "runs", title: "Runs", room: Runs },
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
