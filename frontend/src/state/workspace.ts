/** Which workspace is open. It stands in the address (`v=`), and each keeps its own state. */

import { signal } from "@preact/signals";

export type Workspace = "plan" | "robot" | "map" | "runs";

const NAMES: readonly string[] = ["plan", "robot", "map", "runs"];

function fromAddress(): Workspace {
  const name = new URLSearchParams(location.hash.slice(1)).get("v") ?? "plan";
  return NAMES.includes(name) ? (name as Workspace) : "plan";
}

export const workspace = signal<Workspace>(fromAddress());

// An address that was typed, pasted or gone back to; the page's own changes do not tell of it.
addEventListener("hashchange", () => {
  workspace.value = fromAddress();
});
