/** One pill says where the plan stands. */

import { fixed, took } from "../geometry/format";
import { nearestCorner } from "../geometry/profile";
import { saferEnd } from "../plan/other-end";
import { connected } from "../state/connection";
import { drawing, isEmpty } from "../state/drawing";
import { answered, plan, preview, refusal } from "../state/planning";
import { slow, waited } from "../state/waiting";
import { Icon } from "../ui/icon";

export function PlanPill() {
  const shown = plan.value;
  if (!connected.value) {
    return (
      <div class="pill mute">
        <Icon name="offline" />
        <b>Offline</b>
        <span class="wide">{shown ? "last plan kept" : "no plan"}</span>
      </div>
    );
  }
  if (isEmpty.value) {
    return (
      <div class="pill mute">
        <b>No terrain</b>
      </div>
    );
  }
  if (slow.value || (!shown && !refusal.value)) {
    return (
      <div class="pill">
        <span class="spin" />
        <b>Planning</b>
        <span class="wide">latest edit, {took(waited.value)}</span>
      </div>
    );
  }
  if (refusal.value) {
    return (
      <div class="pill bad" title={refusal.value}>
        <Icon name="warning" />
        <b>{/^robot\b/.test(refusal.value) ? "Not a robot" : "Not a terrain"}</b>
      </div>
    );
  }
  if (preview.value && !preview.value.problem) {
    return (
      <div class="pill" title="The paper's poses for what is drawn; the full path follows at rest">
        <Icon name="check" />
        <b>Key poses</b>
        <span class="wide">solved in {took(preview.value.solve_time)}</span>
      </div>
    );
  }
  const refused = preview.value ?? shown;
  if (refused?.problem) {
    const { at, message } = refused.problem;
    const corner = nearestCorner(drawing.value.points, at);
    return (
      <div class="pill bad" title={message}>
        <Icon name="warning" />
        <b>Infeasible</b>
        <span class="wide">
          {refused.facing === "backward" && "backward, "}at x {fixed(at[0], 2)} m
          {corner ? `, ${corner}` : ""}
        </span>
      </div>
    );
  }
  const motion = shown?.certificate?.motion;
  if (motion) {
    return (
      <div class="pill warn" title={motion.message}>
        <Icon name="warning" />
        <b>Poses only</b>
        <span class="wide">motion not certified at x {fixed(motion.at[0], 2)} m</span>
      </div>
    );
  }
  const safer = saferEnd(shown);
  if (safer) {
    return (
      <div class="pill warn" title={`${safer}: plan it so in the inspector, under Facing`}>
        <Icon name="warning" />
        <b>Feasible, thin</b>
        <span class="wide">{safer}</span>
      </div>
    );
  }
  return (
    <div
      class="pill"
      title={`This answer came after ${took(answered.value)}; the planner took ${took(shown!.solve_time)} when it solved it`}
    >
      <Icon name="check" />
      <b>Feasible</b>
      <span class="wide">
        {shown!.facing === "backward" ? "backward, " : ""}
        {shown!.certificate?.passed ? "certified, " : ""}
        {took(answered.value)}
      </span>
    </div>
  );
}
