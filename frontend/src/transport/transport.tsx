/** Play, step, speed, and the timeline with its key poses. */

import { hasFailed } from "../api/types";
import { fixed } from "../geometry/format";
import { PANELS, type PanelId } from "../plots/lines";
import { shownPanels } from "../plots/plots";
import { plan } from "../state/planning";
import {
  duration,
  keyTimes,
  plannedEnd,
  playing,
  SPEEDS,
  seek,
  shownRun,
  shownTime,
  speed,
  stepKey,
  time,
  togglePlay,
} from "../state/playback";
import { progress, running } from "../state/rollouts";
import { Icon } from "../ui/icon";
import { IconButton } from "../ui/icon-button";
import { Menu, MenuItem } from "../ui/menu";

export function Transport() {
  const none = duration.value <= 0;
  return (
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
      <Timeline />
      <KeyLegend />
      <PlotMenu />
      <SpeedMenu />
    </div>
  );
}

function Clock() {
  const shown = plan.value;
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
        {fixed(shown.problem.progress, 2)} <small>m, stop</small>
      </div>
    );
  }
  return (
    <div class="tm">
      {fixed(shownTime.value, 2)} <small>/ {fixed(plannedEnd.value, 2)} s</small>
    </div>
  );
}

const STEP = 0.1;
const LEAP = 1;

function Timeline() {
  const end = plannedEnd.value;
  const share = (t: number) => `${end > 0 ? Math.min(100, (t / end) * 100) : 0}%`;
  const growing = running.value === "a";
  const failed = hasFailed(shownRun.value);
  const at = (event: PointerEvent) => {
    const rect = (event.currentTarget as HTMLElement).getBoundingClientRect();
    playing.value = false;
    seek(((event.clientX - rect.left) / rect.width) * end);
  };
  const onKeyDown = (event: KeyboardEvent) => {
    const to: Record<string, number> = {
      ArrowRight: time.peek() + STEP,
      ArrowLeft: time.peek() - STEP,
      ArrowUp: time.peek() + STEP,
      ArrowDown: time.peek() - STEP,
      PageUp: time.peek() + LEAP,
      PageDown: time.peek() - LEAP,
      Home: 0,
      End: duration.peek(),
    };
    if (event.key === " ") {
      event.preventDefault();
      togglePlay();
    }
    const next = to[event.key];
    if (next === undefined) return;
    event.preventDefault();
    playing.value = false;
    seek(next);
  };
  return (
    <div
      class="scrub"
      role="slider"
      tabIndex={0}
      aria-label="Time"
      aria-valuemin={0}
      aria-valuemax={end}
      aria-valuenow={shownTime.value}
      aria-valuetext={`${fixed(shownTime.value, 2)} s of ${fixed(end, 2)} s`}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        at(event);
      }}
      onPointerMove={(event) => event.buttons === 1 && at(event)}
      onKeyDown={onKeyDown}
    >
      <s
        class={growing ? "buf" : failed ? "fell" : ""}
        style={{ width: growing ? share(progress.value * end) : share(shownTime.value) }}
      />
      {keyTimes.value.map((at, k) => (
        <i key={k} style={{ left: share(at) }} title={`Key pose ${k + 1}`} />
      ))}
      {end > 0 && <em style={{ left: share(shownTime.value) }} />}
    </div>
  );
}

function KeyLegend() {
  return (
    <div class="keyl" aria-hidden="true">
      <span class="front">
        <i />
        front
      </span>
      <span class="rear">
        <i />
        rear
      </span>
      <span>
        <i />
        actual
      </span>
      <span>
        <i class="fat" />
        desired
      </span>
      <span class="third">
        <i />
        wheel / CoM
      </span>
      <span class="fourth">
        <i />
        friction
      </span>
    </div>
  );
}

function PlotMenu() {
  const toggle = (id: PanelId) => {
    const now = shownPanels.peek();
    const all = Object.keys(PANELS) as PanelId[];
    const next = now.includes(id)
      ? now.filter((p) => p !== id)
      : all.filter((p) => p === id || now.includes(p));
    if (next.length > 0) shownPanels.value = next;
  };
  return (
    <Menu
      label="Plots"
      button={<Icon name="chart" />}
      buttonClass="t ico"
      align="right"
      panelClass="up"
    >
      {() =>
        (Object.keys(PANELS) as PanelId[]).map((id) => (
          <button
            key={id}
            type="button"
            class="item"
            role="menuitemcheckbox"
            tabIndex={-1}
            aria-checked={shownPanels.value.includes(id)}
            onClick={() => toggle(id)}
          >
            {PANELS[id]}
          </button>
        ))
      }
    </Menu>
  );
}

function SpeedMenu() {
  const button = (
    <>
      <span class="sr">Speed</span> {speed.value}×
      <Icon name="down" />
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
