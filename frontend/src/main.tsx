/** Start: read what there is, restore the address or open the sample, then follow every change. */

import { effect } from "@preact/signals";
import { render } from "preact";
import { getSettings } from "./api/client";
import { App } from "./app";
import { LATER } from "./parts";
import { fit } from "./profile-editor/viewport";
import { renewSession, startScene } from "./scene/drive";
import { startAnnouncing } from "./state/announce";
import { readRobots, readTerrains } from "./state/catalogue";
import { report, watchConnection } from "./state/connection";
import { drawing, open, startHistory } from "./state/drawing";
import { startEffect } from "./state/effect";
import { startPlanning } from "./state/planner";
import { plan, settled } from "./state/planning";
import { duration, seek, startClock } from "./state/playback";
import { restoreRollout, resumeRollout } from "./state/rollouts";
import { allRobots, robotName, robots, settings, terrains } from "./state/setup";
import { type Restored, restoreFromAddress, startSharing } from "./state/share";
import { resumeTrials } from "./state/trials";
import { fetchWhileIdle } from "./ui/part";
import "uplot/dist/uPlot.min.css";
import "./styles/index.css";

const SAMPLE = "three-stairs-up";

async function readCatalogue(): Promise<void> {
  const [known] = await Promise.all([getSettings(), readTerrains(), readRobots()]);
  settings.value = known;
  const name = robotName.peek();
  // One that was read from a file or came in a link is in no catalogue.
  if (!allRobots.peek().some((r) => r.name === name))
    robotName.value = robots.peek()[0]?.name ?? "";
}

/** A robot half-way up says more than one that waits at the foot. */
const TELLING = 0.43;

function showMiddle(): void {
  const stop = effect(() => {
    if (!plan.value) return;
    seek(duration.peek() * TELLING);
    queueMicrotask(() => stop());
  });
}

async function restoreResults(restored: Restored | null): Promise<void> {
  if (restored?.rollout) await restoreRollout(restored.rollout, restored.rolloutB).catch(report);
}

let started = false;

async function begin(): Promise<void> {
  await readCatalogue();
  if (started) return;
  started = true;
  const restored = restoreFromAddress();
  if (!restored) {
    const sample = terrains.peek().find((t) => t.name === SAMPLE) ?? terrains.peek()[0];
    if (sample) open(sample, sample.name);
    showMiddle();
  }
  fit(drawing.peek().points);
  startHistory();
  startSharing((pasted) => {
    fit(drawing.peek().points);
    void restoreResults(pasted);
  });
  await restoreResults(restored);
  void resumeRollout();
  void resumeTrials();
  await settled();
  fetchWhileIdle(LATER);
}

render(<App />, document.getElementById("app")!);
startPlanning();
startEffect();
startClock();
startAnnouncing();
startScene();
begin().catch(report);
watchConnection(() => {
  begin().catch(report);
  void renewSession();
});
