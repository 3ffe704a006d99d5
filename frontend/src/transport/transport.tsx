/** Play, step and speed; timeline and margins on one axis. */

import { computed } from "@preact/signals";
import { fixed } from "../geometry/format";
import { plan } from "../state/planning";
import {
  duration,
  plannedEnd,
  playing,
  SPEEDS,
  shownTime,
  speed,
  stepKey,
  togglePlay,
} from "../state/playback";
import { IconButton } from "../ui/icon-button";
import { Menu, MenuItem } from "../ui/menu";
import { type AxisKind, axisKind } from "./axis";
import { MarginRows } from "./margin-rows";
import { SpeedLegend } from "./speed-row";
import { Ticks, Timeline } from "./timeline";

const nothing = computed(() => duration.value <= 0);

export function Transport() {
  const none = nothing.value;
  return (
    <div class="time">
      <div class="tr-bar" role="group" aria-label="Playback">
        <IconButton
          action={() => stepKey(-1)}
          label="Previous key pose"
          icon="start"
          fill
          off={none}
        />
        <IconButton
          action={togglePlay}
          label={playing.value ? "Pause" : "Play"}
          icon={playing.value ? "pause" : "play"}
          fill={!playing.value}
          off={none}
        />
        <IconButton action={() => stepKey(1)} label="Next key pose" icon="end" fill off={none} />
        <Clock />
        <SpeedMenu />
      </div>
      <Timeline />
      <AxisSwitch />
      <Ticks />
      <MarginRows />
      <SpeedLegend />
    </div>
  );
}

/** From here on tenths are told, else hundredths: both times fit beside the buttons [s]. */
const LONG = 100;

function Clock() {
  const shown = plan.value;
  const digits = plannedEnd.value < LONG ? 2 : 1;
  if (duration.value <= 0) {
    return (
      <div class="tm">
        <small>– / – s</small>
      </div>
    );
  }
  if (shown?.problem && shownTime.value >= duration.value - 1e-6) {
    return (
      <div class="tm">
        <small>stops at</small> {fixed(duration.value, 1)} <small>s</small>
      </div>
    );
  }
  return (
    <div class="tm">
      {fixed(shownTime.value, digits)} <small>/ {fixed(plannedEnd.value, digits)} s</small>
    </div>
  );
}

function SpeedMenu() {
  const button = (
    <>
      <span class="sr">Speed</span> {speed.value}×
    </>
  );
  return (
    <Menu label="Speed" named button={button} buttonClass="t" align="right" panelClass="up">
      {(close) =>
        SPEEDS.map((each) => (
          <MenuItem
            key={each}
            checked={each === speed.value}
            onChoose={() => {
              speed.value = each;
              close();
            }}
          >
            {each}×
          </MenuItem>
        ))
      }
    </Menu>
  );
}

const KINDS: [AxisKind, string][] = [
  ["time", "Time"],
  ["place", "Place"],
];

/** What margins and key poses are laid out along. */
function AxisSwitch() {
  return (
    <fieldset class="axis">
      <legend>Margins along</legend>
      {KINDS.map(([kind, title]) => (
        <button
          key={kind}
          type="button"
          aria-pressed={axisKind.value === kind}
          title={kind === "time" ? "Along the clock [s]" : "Along the ground: x of the trunk [m]"}
          onClick={() => {
            axisKind.value = kind;
          }}
        >
          {title}
        </button>
      ))}
    </fieldset>
  );
}
