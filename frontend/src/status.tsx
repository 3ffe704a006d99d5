/** The last line: what was planned, which keys help, whether the service answers. */

import { fixed, millimetres } from "./geometry/format";
import { worst } from "./profile-editor/margins";
import { connected, latency } from "./state/connection";
import { outdated, plan } from "./state/planning";
import type { Workspace } from "./state/workspace";
import { openRoom } from "./workspaces";

const KEYS: Partial<Record<Workspace, string[][]>> = {
  plan: [
    ["X", "swap"],
    ["M", "maximise"],
    ["I", "inspector"],
    ["Space", "play"],
    ["?", "all keys"],
  ],
  robot: [
    ["Drag", "a dimension"],
    ["Alt", "fine"],
    ["Enter", "type a value"],
    ["Ctrl Z", "undo"],
  ],
};

export function Status() {
  const shown = plan.value;
  return (
    <footer class="stat">
      {shown && (
        <span>
          <b>
            {shown.poses.length} poses
            {shown.problem ? "" : `, ${shown.critical.length} key`}
          </b>
          {shown.problem && "up to the problem"}
        </span>
      )}
      {shown && outdated.value && <span>of the drawing before the latest edit</span>}
      {shown && !shown.problem && !outdated.value && <Certified />}
      <Keys />
      <div class="grow" />
      <span>
        <i class={connected.value ? "live" : "live bad"} />
        {connected.value
          ? `Connected${latency.value === null ? "" : `, ${fixed(latency.value, 0)} ms`}`
          : "Disconnected"}
      </span>
    </footer>
  );
}

function Keys() {
  return (
    <span class="keys">
      {(KEYS[openRoom().name] ?? []).map(([key, does]) => (
        <span key={key}>
          <kbd>{key}</kbd>
          {does}
        </span>
      ))}
    </span>
  );
}

function Certified() {
  const shown = plan.value!;
  const certificate = shown.certificate as { passed?: boolean; scope?: string } | null | undefined;
  const clearance = millimetres(worst(shown.poses, "clearance"));
  if (shown.certificate?.motion) {
    return (
      <span class="warn">
        Poses checked, motion between them not; smallest clearance {clearance}
      </span>
    );
  }
  if (!certificate?.passed) return <span>smallest clearance {clearance}</span>;
  return (
    <span>
      <b>Certified</b>
      {certificate.scope === "poses" ? "poses checked" : "exact check"}, smallest clearance{" "}
      {clearance}
    </span>
  );
}
