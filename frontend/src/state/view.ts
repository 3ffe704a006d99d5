/** How the page looks: theme, layers, layout. Nothing here changes an answer. */

import { computed, effect, signal } from "@preact/signals";
import { kept, readFlag, store, stored } from "./kept";

export { inspectorOpen } from "./layout";

export type Theme = "dark" | "light";
export type Tool = "select" | "stair" | "ramp" | "flat" | "free";
export type Tab = "editor" | "scene" | "results";
export type InspectorPage = "plan" | "controller" | "trials";

export const LAYERS = {
  ghosts: "Poses between",
  keys: "Key poses",
  collision: "Collision points",
  wheel: "Wheel-centre path",
  com: "CoM path",
  speed: "Speed of a fast plan",
  dimensions: "Dimensions",
} as const;
export type Layer = keyof typeof LAYERS;

/** Layers that only the scene has, in the service's words. */
export const SCENE_ONLY = ["forces", "support", "com", "compare"] as const;
export type SceneLayer = (typeof SCENE_ONLY)[number];
export const sceneLayers = signal<ReadonlySet<SceneLayer>>(new Set(SCENE_ONLY));
export const legendOpen = kept("legend", false, readFlag);

const systemIsLight = matches("(prefers-color-scheme: light)");
/** Whoever never chose has the system's, also where that changes in the evening. */
const chosenTheme = kept<Theme | "system">("theme", "system", (text) =>
  text === "light" || text === "dark" ? text : null,
);
export const theme = computed<Theme>(() => {
  if (chosenTheme.value !== "system") return chosenTheme.value;
  return systemIsLight.value ? "light" : "dark";
});
export const tool = signal<Tool>("select");
export const layers = signal<ReadonlySet<Layer>>(new Set(Object.keys(LAYERS) as Layer[]));
/** The table of the profile's points is open. */
export const pointsOpen = signal(false);
export const tab = signal<Tab>("editor");
export const inspectorPage = signal<InspectorPage>("plan");

export const hintSeen = signal(stored("hint") === "seen");

export function dismissHint(): void {
  if (hintSeen.peek()) return;
  hintSeen.value = true;
  store("hint", "seen");
}

export function toggleTheme(): void {
  chosenTheme.value = theme.peek() === "dark" ? "light" : "dark";
}

export function toggleSceneLayer(layer: SceneLayer): void {
  const next = new Set(sceneLayers.peek());
  if (!next.delete(layer)) next.add(layer);
  sceneLayers.value = next;
}

export function toggleLayer(layer: Layer): void {
  const next = new Set(layers.peek());
  if (!next.delete(layer)) next.add(layer);
  layers.value = next;
}

effect(() => {
  document.documentElement.dataset.theme = theme.value;
});

function matches(media: string) {
  const query = matchMedia(media);
  const now = signal(query.matches);
  query.addEventListener("change", () => {
    now.value = query.matches;
  });
  return now;
}

/** The top bar wraps, and figures are lines of text. */
export const isNarrow = matches("(max-width: 899px)");
/** Tabs choose what is shown; as in styles/tabs.css. */
export const oneArea = matches("(max-width: 599px), (max-width: 899px) and (max-height: 999px)");
