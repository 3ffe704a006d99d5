/** Tells this page's 3-D scene what to show: plan, rollout, theme, time. */

import { effect, signal, untracked } from "@preact/signals";
import {
  ApiError,
  dropSession,
  postSession,
  putPlayback,
  putScene,
  type Session,
} from "../api/client";
import type { Plan } from "../api/types";
import { connected, report } from "../state/connection";
import { live } from "../state/live";
import { plan, planB, stale } from "../state/planning";
import { playing, shownRun, shownTime, speed } from "../state/playback";
import { run, runB } from "../state/rollouts";
import { compare } from "../state/setup";
import { type Layer, layers, SCENE_ONLY, sceneLayers, theme } from "../state/view";

export const session = signal<Session | null>(null);

/** Terrain and poses at most 20 times a second. */
const INTERVAL = 50;

/** One PUT in flight per address; of the bodies that come meanwhile only the merged newest goes. */
class Line {
  private waiting: Record<string, unknown> | null = null;
  private busy = false;

  constructor(
    private readonly send: (id: string, body: Record<string, unknown>) => Promise<unknown>,
  ) {}

  put(body: Record<string, unknown>): void {
    this.waiting = { ...this.waiting, ...body };
    if (!this.busy) void this.flush();
  }

  private async flush(): Promise<void> {
    this.busy = true;
    while (this.waiting) {
      const id = session.peek()?.id;
      const body = this.waiting;
      this.waiting = null;
      if (!id || !connected.peek()) break;
      try {
        await this.send(id, body);
      } catch (error) {
        report(error);
        if (error instanceof ApiError && error.status === 404) await renewSession();
      }
      await new Promise((wait) => setTimeout(wait, INTERVAL));
    }
    this.busy = false;
  }
}

const scene = new Line(putScene);
const playback = new Line(putPlayback);

/** A new scene: at start, and after the service was restarted. */
export async function renewSession(): Promise<void> {
  try {
    session.value = await postSession();
    tellAll();
  } catch (error) {
    session.value = null;
    report(error);
  }
}

/** The page's layers in the scene's words. */
const SCENE_LAYERS: Partial<Record<Layer, string>> = {
  keys: "ghosts",
  collision: "collision_points",
  com: "com_path",
  wheel: "wheel_path",
};

/** Theme and layers at once; what they show as soon as there is a plan. */
function sceneBody(): Record<string, unknown> {
  return { ...(plan.value ? contents(plan.value) : {}), ...looks() };
}

function contents(shown: Plan): Record<string, unknown> {
  const other = compare.value ? (runB.value?.plan_id ?? planB.value?.id) : null;
  return {
    plan_id: shown.id,
    rollout_id: live.value || !shownRun.value ? null : (run.value?.id ?? null),
    compare_plan_id: other ?? null,
  };
}

function looks(): Record<string, unknown> {
  return {
    theme: theme.value,
    layers: Object.fromEntries([
      ...Object.entries(SCENE_LAYERS).map(([ours, theirs]) => [
        theirs,
        layers.value.has(ours as Layer),
      ]),
      ...SCENE_ONLY.map((layer) => [layer, sceneLayers.value.has(layer)]),
    ]),
  };
}

function tellAll(): void {
  scene.put(untracked(sceneBody));
  playback.put({ time: shownTime.peek(), playing: playing.peek(), speed: speed.peek() });
}

export function setCamera(preset: string): void {
  scene.put({ camera: preset });
}

/** Less than anyone could see of it [s]. */
const STIR = 1e-4;
let stirred = false;

/** Has the scene draw a frame although nothing changes. */
export function stirScene(): void {
  stirred = !stirred;
  if (!playing.peek()) playback.put({ time: shownTime.peek() + (stirred ? STIR : 0) });
}

/** A running rollout is not stored yet: the scene shows its plan, as far along as the robot is. */
function moment(time: number): Record<string, unknown> {
  const along = live.peek()?.series.progress;
  return along ? { time: undefined, progress: along[along.length - 1] } : { time };
}

export function startScene(): void {
  void renewSession();
  effect(() => {
    scene.put(sceneBody());
  });
  // While playing, the scene runs its own clock; seeking and previews set it.
  effect(() => {
    playback.put({ time: shownTime.peek(), playing: playing.value, speed: speed.value });
  });
  effect(() => {
    const time = shownTime.value;
    if (!playing.peek() && !stale.peek()) playback.put(moment(time));
  });
  addEventListener("pagehide", () => {
    const id = session.peek()?.id;
    if (id) dropSession(id);
  });
  // Brought back from the browser's cache: the old scene is gone.
  addEventListener("pageshow", (event) => {
    if (event.persisted) void renewSession();
  });
}
