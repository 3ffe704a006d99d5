/** The top bar: what is planned, what came of it, and what to do with it. */

import { useEffect, useState } from "preact/hooks";
import type { RobotDocument } from "../api/types";
import { fixed } from "../geometry/format";
import { readRobots } from "../state/catalogue";
import { report } from "../state/connection";
import { drawnName, isEdited } from "../state/drawing";
import { allRobots, robotEdits, robotName } from "../state/setup";
import { theme, toggleTheme } from "../state/view";
import { Icon, Logo } from "../ui/icon";
import { Menu, MenuItem } from "../ui/menu";
import { DownloadMenu } from "./download-menu";
import { Friction } from "./friction";
import { PlanPill } from "./plan-pill";
import { RunButton } from "./run-button";
import { TerrainMenu } from "./terrain-menu";
import { WorkspaceTabs } from "./workspace-tabs";

export function TopBar() {
  return (
    <header class="top">
      <h1 class="brand" aria-label="Stairwright">
        <Logo />
        <span class="wide">Stairwright</span>
      </h1>
      <WorkspaceTabs />
      <TerrainMenu
        button={
          <>
            <small class="quiet">Terrain</small> <b title={drawnName.value}>{drawnName.value}</b>
            {isEdited.value && <span class="dot" title="Edited, not saved" />}
            <Icon name="down" />
          </>
        }
      />
      <div class="sep" />
      <RobotMenu />
      <Friction />
      <div class="grow" />
      <PlanPill />
      <RunButton />
      <div class="sep" />
      <DownloadMenu />
      <ShareButton />
      <button
        type="button"
        class="btn sq"
        aria-label={theme.value === "dark" ? "Light theme" : "Dark theme"}
        title={theme.value === "dark" ? "Light theme" : "Dark theme"}
        onClick={toggleTheme}
      >
        <Icon name={theme.value === "dark" ? "moon" : "sun"} />
      </button>
    </header>
  );
}

function RobotMenu() {
  const button = (
    <>
      <small class="quiet">Robot</small> <b title={robotName.value}>{robotName.value}</b>
      {robotEdits.value[robotName.value] && <span class="dot" title="Not saved" />}
      <Icon name="down" />
    </>
  );
  return (
    <Menu label="Robot" named button={button} buttonClass="fld" panelClass="robots">
      {(close) => <RobotItems close={close} />}
    </Menu>
  );
}

function RobotItems({ close }: { close: () => void }) {
  useEffect(() => void readRobots().catch(report), []);
  return (
    <>
      {allRobots.value.map((robot) => (
        <MenuItem
          key={robot.name}
          checked={robot.name === robotName.value}
          onChoose={() => {
            robotName.value = robot.name;
            close();
          }}
        >
          <span class="two">
            {robot.name}
            <small>{robot.description}</small>
            <small class="facts">{facts(robot)}</small>
          </span>
        </MenuItem>
      ))}
    </>
  );
}

/** What decides how high it gets. */
function facts(robot: RobotDocument): string {
  const { trunk, thigh, calf, wheel } = robot;
  const mass = trunk.mass + 4 * (thigh.mass + calf.mass + wheel.mass);
  const leg = thigh.length + calf.length;
  return `${fixed(mass, 1)} kg · legs ${fixed(leg, 2)} m · wheels ⌀ ${fixed(2 * wheel.radius, 2)} m`;
}

const SHOWN = 2000;

function ShareButton() {
  const [state, setState] = useState<"idle" | "copied" | "refused">("idle");
  const copy = async () => {
    try {
      await navigator.clipboard.writeText(location.href);
      setState("copied");
    } catch {
      setState("refused");
    }
    setTimeout(() => setState("idle"), SHOWN);
  };
  return (
    <div class="menu-root">
      <button
        type="button"
        class="btn sq"
        aria-label="Copy share link"
        title="Copy share link"
        onClick={copy}
      >
        <Icon name={state === "copied" ? "check" : "link"} />
      </button>
      {state !== "idle" && (
        <div class="bubble" role="status">
          {state === "copied" ? "Link copied" : "Copy it from the address bar"}
        </div>
      )}
    </div>
  );
}
