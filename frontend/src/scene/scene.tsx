/** The 3-D scene: viser's page in a frame, with our header. */

import { computed } from "@preact/signals";
import { useRef, useState } from "preact/hooks";
import { hasFailed } from "../api/types";
import { fixed } from "../geometry/format";
import { PanelTools } from "../plan/panel-tools";
import { dragging } from "../profile-editor/gestures";
import { connected } from "../state/connection";
import { held, isEmpty } from "../state/drawing";
import { livePlan } from "../state/live";
import { plan } from "../state/planning";
import { duration, shownRun, shownTime } from "../state/playback";
import { legendOpen, theme } from "../state/view";
import { Icon } from "../ui/icon";
import { IconButton } from "../ui/icon-button";
import { Menu, MenuItem } from "../ui/menu";
import { useRoving } from "../ui/roving";
import { session, setCamera } from "./drive";
import { leaveTime } from "./leave-time";
import { SceneLegend } from "./legend";
import { saveScene } from "./picture";
import { recording, recordVideo, stopVideo } from "./video";

const CAMERAS: [string, string][] = [
  ["follow", "Follow the robot"],
  ["side", "Side"],
  ["front", "Front"],
  ["iso", "Three-quarter"],
];

/** A hand that has not moved for so long rests [ms]. */
const REST = 120;
let moved = Number.NEGATIVE_INFINITY;
addEventListener("pointermove", (event) => (moved = event.timeStamp), true);

/** Something is being dragged, and the page has to follow. */
const handMoves = () =>
  (dragging.peek() !== null || held.peek()) && performance.now() - moved < REST;

const moves = computed(() => duration.value > 0);

export function Scene() {
  const address = session.value?.scene;
  const bar = useRef<HTMLDivElement>(null);
  useRoving(bar);
  return (
    <>
      <div ref={bar} class="ph" role="toolbar" aria-label="Scene tools">
        <h2>3-D scene</h2>
        <Menu label="Camera" button={<Icon name="camera" />} buttonClass="t ico" align="right">
          {(close) =>
            CAMERAS.map(([preset, title]) => (
              <MenuItem
                key={preset}
                onChoose={() => {
                  setCamera(preset);
                  close();
                }}
              >
                {title}
              </MenuItem>
            ))
          }
        </Menu>
        <button
          type="button"
          class="t ico"
          aria-label="Reset view"
          title="Reset view"
          onClick={() => setCamera("iso")}
        >
          <Icon name="reset" />
        </button>
        <a
          class="t ico"
          aria-label="Open the scene in its own window"
          title="Open in its own window"
          href={address}
          target="_blank"
          rel="noreferrer"
        >
          <Icon name="open" />
        </a>
        <IconButton
          action={() => void saveScene()}
          label="Save the scene as PNG"
          icon="download"
          off={!address}
        />
        <RecordButton off={!address || !moves.value} />
        <button
          type="button"
          class={legendOpen.value ? "t ico on" : "t ico"}
          aria-label="Legend"
          title="Legend and what is shown (L)"
          aria-keyshortcuts="L"
          aria-pressed={legendOpen.value}
          onClick={() => {
            legendOpen.value = !legendOpen.value;
          }}
        >
          <Icon name="list" />
        </button>
        <PanelTools panel="scene" title="scene" />
      </div>
      <div class="v3">
        {address && <SceneFrame key={session.value!.id} address={address} />}
        {!isEmpty.value && connected.value && <Tag />}
        {!isEmpty.value && connected.value && <SceneLegend />}
        {(!connected.value || isEmpty.value) && <SceneVeil />}
      </div>
    </>
  );
}

function SceneFrame({ address }: { address: string }) {
  // With the theme as it is now: another address later would load the scene anew.
  const [source] = useState(() => `${address}?embedded=1&hideViserLogo&theme=${theme.peek()}`);
  return (
    <iframe
      src={source}
      title="3-D scene"
      allow="fullscreen"
      onLoad={(event) => leaveTime(event.currentTarget.contentWindow!, handMoves)}
    />
  );
}

function RecordButton({ off }: { off: boolean }) {
  const now = recording.value;
  const label = now ? "Stop and save the video" : "Record the replay as a video";
  return (
    <button
      type="button"
      class={now ? "t ico rec" : "t ico"}
      aria-label={label}
      title={label}
      disabled={off}
      onClick={now ? stopVideo : recordVideo}
    >
      <Icon name="record" />
    </button>
  );
}

function Tag() {
  const rollout = shownRun.value;
  const t = fixed(shownTime.value, 2);
  if (plan.value?.poses.length === 0) return null;
  if (plan.value?.problem && shownTime.value >= duration.value - 1e-6) {
    return (
      <div class="tag2">
        <span class="live bad" />
        problem pose
      </div>
    );
  }
  if (rollout && hasFailed(rollout) && shownTime.value >= duration.value - 0.05) {
    return (
      <div class="tag2">
        <span class="live bad" />
        {rollout.outcome} · {t} s
      </div>
    );
  }
  return (
    <div class="tag2">
      {livePlan.value && rollout?.outcome !== "cancelled" && <span class="live" />}
      {rollout?.outcome === "cancelled" ? "cancelled rollout" : rollout ? "rollout" : "plan"} · {t}{" "}
      s
    </div>
  );
}

function SceneVeil() {
  return (
    <div class="veil">
      {connected.value ? (
        <>
          <b>Nothing to show yet</b>
          the scene follows the profile
        </>
      ) : (
        <>
          <Icon name="offline" />
          <b>Scene disconnected</b>
          the camera is kept
        </>
      )}
    </div>
  );
}
