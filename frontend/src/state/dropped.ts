/** A robot's file that was dropped on the page: the workspace Robot takes it when it is there. */

import { signal } from "@preact/signals";

export const droppedRobot = signal<File | null>(null);
