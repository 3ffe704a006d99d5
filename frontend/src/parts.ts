/** What of the page comes in files of its own, in the order in which it is likely to be wanted. */

import { Part } from "./ui/part";

export const plots = new Part("The plots", async () => (await import("./plots/plots")).Plots);

export const robotRoom = new Part(
  "The robot",
  async () => (await import("./robot/robot")).RobotRoom,
);
export const mapRoom = new Part("The map", async () => (await import("./map/map")).MapRoom);
export const runsRoom = new Part(
  "The list of runs",
  async () => (await import("./runs/runs")).Runs,
);
export const designs = new Part(
  "The design study",
  async () => (await import("./designs/designs")).Designs,
);

export const pointsTable = new Part(
  "The table of points",
  async () => (await import("./topbar/points-table")).PointsTable,
);
export const cutDialog = new Part(
  "The cut through the mesh",
  async () => (await import("./import/cut-dialog")).CutDialog,
);

/** All that nobody waits for when the page opens. */
export const LATER = [robotRoom, mapRoom, runsRoom, pointsTable, cutDialog, designs];
