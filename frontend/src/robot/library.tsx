/** The robots there are: presets, one's own, those just read from files; and the door for files. */

import { useEffect, useMemo, useRef } from "preact/hooks";
import type { RobotDocument } from "../api/types";
import { fixed } from "../geometry/format";
import { robotShape, skeleton } from "../geometry/robot";
import { stance } from "../geometry/stance";
import { Figure } from "../profile-editor/figure";
import type { Projection } from "../profile-editor/viewport";
import { readRobots } from "../state/catalogue";
import { report } from "../state/connection";
import { robotEdits, robotName, robots, unsavedRobots } from "../state/setup";
import { Icon } from "../ui/icon";
import { choose } from "./edit";
import { totalMass } from "./quantities";
import { ReadReport } from "./read-report";
import { dismiss, readFile, remove } from "./shelf";

export function Library() {
  useEffect(() => void readRobots().catch(report), []);
  const file = useRef<HTMLInputElement>(null);
  const unsaved = unsavedRobots.value;
  const own = robots.value.filter((r) => !r.readonly);
  return (
    <aside class="library" aria-label="Robots">
      <header class="hd">
        <h2>Robots</h2>
      </header>
      <div class="shelf">
        {robots.value
          .filter((r) => r.readonly)
          .map((r) => (
            <Entry key={r.name} robot={r} />
          ))}
        {own.length > 0 && <h3>Yours</h3>}
        {own.map((r) => (
          <Entry key={r.name} robot={r} onRemove={() => void remove(r)} verb="Delete" />
        ))}
        {unsaved.length > 0 && <h3>Not saved</h3>}
        {unsaved.map((robot) => (
          <Entry key={robot.name} robot={robot} onRemove={() => dismiss(robot.name)} verb="Close" />
        ))}
      </div>
      <div class="drop-here">
        <b>Drop URDF, MJCF, zip or YAML</b>
        <span>
          or{" "}
          <button type="button" onClick={() => file.current?.click()}>
            choose a file
          </button>
        </span>
        <input
          ref={file}
          type="file"
          hidden
          aria-label="Robot file"
          accept=".urdf,.xml,.mjcf,.zip,.yaml,.yml,.json"
          onChange={(event) => {
            const chosen = event.currentTarget.files?.[0];
            event.currentTarget.value = "";
            if (chosen) void readFile(chosen);
          }}
        />
      </div>
      <ReadReport />
    </aside>
  );
}

interface EntryProps {
  robot: RobotDocument;
  onRemove?: () => void;
  verb?: string;
}

function Entry({ robot, onRemove, verb }: EntryProps) {
  const shown = robotEdits.value[robot.name] ?? robot;
  const edited = shown !== robot;
  const current = robot.name === robotName.value;
  return (
    <div class={`entry${current ? " on" : ""}`}>
      <button type="button" aria-pressed={current} onClick={() => choose(robot.name)}>
        <Thumbnail robot={robot} />
        <span>
          <b title={robot.name}>
            {robot.name}
            {edited && <i class="dot" title="Edited, not saved" />}
          </b>
          <small>{fixed(totalMass(shown), 1)} kg</small>
        </span>
      </button>
      {onRemove && (
        <button
          type="button"
          class="t ico"
          aria-label={`${verb} ${robot.name}`}
          title={`${verb} ${robot.name}`}
          onClick={onRemove}
        >
          <Icon name={verb === "Delete" ? "trash" : "close"} />
        </button>
      )}
    </div>
  );
}

const WIDE = 64;
const TALL = 40;

/** All to one scale would hide the small ones: each fills its own frame. */
function Thumbnail({ robot }: { robot: RobotDocument }) {
  const drawn = useMemo(() => {
    const shape = robotShape(robot);
    const bones = skeleton(shape, stance(robot));
    const wheels = bones.legs.map((joints) => joints[2]!);
    const all = [...bones.outline.flat(), ...bones.legs.flat()];
    const xs = [
      ...all,
      ...wheels.map((w) => [w[0] - shape.wheel]),
      ...wheels.map((w) => [w[0] + shape.wheel]),
    ];
    const [left, right] = [Math.min(...xs.map((p) => p[0]!)), Math.max(...xs.map((p) => p[0]!))];
    const top = Math.max(...all.map((p) => p[1]!));
    const scale = Math.min((WIDE - 4) / (right - left), (TALL - 5) / top);
    const px = (x: number) => WIDE / 2 + (x - (left + right) / 2) * scale;
    const py = (z: number) => TALL - 2 - z * scale;
    const to: Projection = {
      px,
      py,
      scale,
      at: (p) => `${px(p[0]).toFixed(1)},${py(p[1]).toFixed(1)}`,
    };
    return { shape, bones, to };
  }, [robot]);
  return (
    <svg class="thumb" viewBox={`0 0 ${WIDE} ${TALL}`} aria-hidden="true">
      <path class="floor" d={`M0 ${TALL - 1.5}H${WIDE}`} />
      <Figure robot={drawn.shape} bones={drawn.bones} to={drawn.to} kind="key" />
    </svg>
  );
}
