/** A and B on the terrain of the top bar: how far each comes, and what is tightest. */

import { signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { Plan, RobotDocument } from "../api/types";
import { fixed, maybe, reason, took } from "../geometry/format";
import { planFrame, poseTimes } from "../geometry/frames";
import { robotShape, skeleton } from "../geometry/robot";
import { PlanOtherEnd } from "../plan/other-end";
import { why } from "../plan/why";
import { Figure } from "../profile-editor/figure";
import { stated, worst } from "../profile-editor/margins";
import { drawing, isEmpty } from "../state/drawing";
import { follow } from "../state/planner";
import { plan, preview, refusal, stale } from "../state/planning";
import { robotName } from "../state/setup";
import { slow } from "../state/waiting";
import { Icon } from "../ui/icon";
import { useMeasured } from "../ui/measured";
import { Menu, MenuItem } from "../ui/menu";
import { rivalName, rivalPending, rivalPlan, rivalRequest, rivals, swap } from "./rival";
import { fitted, previewSize } from "./stage";

/** How far along both are shown: a robot half-way up says more than one that waits. */
const share = signal(0.43);

export function Preview() {
  useEffect(() => follow(rivalRequest, rivalPlan, rivalPending), []);
  const a = preview.value ?? plan.value;
  return (
    <section class="preview" aria-label="Two robots on this terrain">
      <div class="rivals">
        <header class="hd">
          <b class="ab">A</b>
          <h2>{robotName.value}</h2>
          <div class="grow" />
          <PlanOtherEnd of={a} />
          <Verdict
            of={a}
            refused={refusal.value !== null && !slow.value}
            waiting={slow.value || (stale.value && !preview.value)}
            live
          />
        </header>
        <Stage of={a} />
        <Facts of={a} refused={refusal.value} />
      </div>
      <div class="rivals">
        <header class="hd">
          <b class="ab b">B</b>
          <Rival />
          <div class="grow" />
          <Verdict
            of={rivalPlan.value}
            refused={refusal.value !== null || !(rivalPending.value || rivalPlan.value)}
            waiting={rivalPending.value}
          />
          <button
            type="button"
            class="t ico"
            aria-label="Swap A and B"
            title="Swap A and B"
            onClick={swap}
          >
            <Icon name="exchange" />
          </button>
        </header>
        <Stage of={rivalPlan.value} />
        <Facts of={rivalPlan.value} refused={null} />
      </div>
      <input
        class="share"
        type="range"
        min={0}
        max={1}
        step={0.005}
        value={share.value}
        aria-label="How far along, both"
        aria-valuetext={`${fixed(100 * share.value, 0)} %`}
        onInput={(event) => {
          share.value = event.currentTarget.valueAsNumber;
        }}
      />
    </section>
  );
}

function Rival() {
  const same = rivalName.value === robotName.value;
  return (
    <Menu
      label="Robot B"
      named
      button={
        <>
          <span class="sr">Robot B</span>
          <b>{rivalName.value}</b>
          {same && <small>as stored</small>}
          <Icon name="down" />
        </>
      }
      buttonClass="t"
      panelClass="rivals-menu"
    >
      {(close) =>
        rivals.value.map((name) => (
          <MenuItem
            key={name}
            checked={name === rivalName.value}
            onChoose={() => {
              rivalName.value = name;
              close();
            }}
          >
            {name}
            {name === robotName.value && <small>as stored</small>}
          </MenuItem>
        ))
      }
    </Menu>
  );
}

interface VerdictProps {
  of: Plan | null;
  /** The service would not plan it; B waits for what A is asked with. */
  refused: boolean;
  waiting: boolean;
  live?: boolean;
}

function Verdict({ of, refused, waiting, live }: VerdictProps) {
  if (isEmpty.value) return <span class="verdict">No terrain</span>;
  if (refused) {
    return (
      <span class="verdict bad">
        <Icon name="warning" />
        Not planned
      </span>
    );
  }
  if (waiting || !of) {
    return (
      <span class="verdict">
        {(live ? slow.value : true) && <span class="spin" />}
        Planning
      </span>
    );
  }
  if (of.problem) {
    return (
      <span class="verdict bad">
        <Icon name="warning" />
        Infeasible
      </span>
    );
  }
  return (
    <span class="verdict ok">
      <Icon name="check" />
      {of.method === "critical" ? "Key poses" : "Feasible"}
      <small>{took(of.solve_time)}</small>
    </span>
  );
}

function Facts({ of, refused }: { of: Plan | null; refused: string | null }) {
  if (refused) return <p class="facts-line why-not error">{reason(refused)}</p>;
  if (!of) return <p class="facts-line" />;
  if (of.problem) return <p class="facts-line why-not">{why(of)}</p>;
  const margin = (name: "com" | "clearance") => fixed(1000 * stated(worst(of.poses, name)), 0);
  return (
    <p class="facts-line">
      <span>
        CoM <b>{margin("com")}</b> mm
      </span>
      <span>
        clearance <b>{margin("clearance")}</b> mm
      </span>
      <span>
        µ needed <b>{fixed(of.friction - stated(worst(of.poses, "friction")), 2)}</b>
      </span>
      <span>
        time <b>{fixed(of.timing.total, 1)}</b> s
      </span>
      <span title="Work of the motors’ static torques along the plan, without losses">
        energy <b>{maybe(of.energy, 0)}</b> J
      </span>
      <span title="That work per unit of weight and distance, without unit">
        cost of transport <b>{maybe(of.cost_of_transport, 2)}</b>
      </span>
      {of.knees && (
        <span>
          knees <b>{of.knees.front}</b>, <b>{of.knees.rear}</b>
        </span>
      )}
    </p>
  );
}

/** Figures beside the one in hand. */
const GHOSTS = 6;

function Stage({ of }: { of: Plan | null }) {
  const box = useMeasured((element) => {
    previewSize.value = { width: element.clientWidth, height: element.clientHeight };
  });
  const { width, height } = previewSize.value;
  return (
    <div class="stage" ref={box}>
      <svg width={width} height={height} role="img" aria-label={told(of)}>
        {width > 0 && <Drawn of={of} />}
      </svg>
    </div>
  );
}

const told = (of: Plan | null) =>
  of ? `${of.robot} over ${of.terrain.name}: ${of.poses.length} poses` : "No plan yet";

/** Each with the robot that was planned, which may be older than the one in hand. */
function Drawn({ of }: { of: Plan | null }) {
  const to = fitted.value;
  const { height } = previewSize.value;
  const ground = drawing.value.points;
  const line = ground.map(to.at).join(" ");
  const [first, last] = [ground[0], ground[ground.length - 1]];
  if (!first || !last) return null;
  const shape = of && robotShape(of.robot_description as RobotDocument);
  const times = of ? poseTimes(of) : [];
  const total = times[times.length - 1] ?? 0;
  const at = (t: number) => (of && shape ? planFrame(of, t) : null);
  const now = at(share.value * total);
  return (
    <>
      <polygon
        class="below"
        points={`${line} ${to.px(last[0])},${height} ${to.px(first[0])},${height}`}
      />
      <polyline class="prof" points={line} />
      {of && shape && (
        <>
          {Array.from({ length: GHOSTS }, (_, k) => at((k / (GHOSTS - 1)) * total)).map(
            (f, k) =>
              f && <Figure key={k} robot={shape} bones={skeleton(shape, f)} to={to} kind="key" />,
          )}
          <polyline class="comp" points={of.poses.map((p) => to.at(p.com)).join(" ")} />
          {now && <Figure robot={shape} bones={skeleton(shape, now)} to={to} kind="cur" />}
        </>
      )}
    </>
  );
}
