/** What the scene's marks mean; each row shows or hides its own. L hides the legend. */

import { compare } from "../state/setup";
import {
  type Layer,
  layers,
  legendOpen,
  type SceneLayer,
  sceneLayers,
  toggleLayer,
  toggleSceneLayer,
} from "../state/view";

const OWN: [SceneLayer, string, string][] = [
  ["forces", "arrow", "Contact force, 3 mm per N"],
  ["support", "plate", "Support polygon"],
  ["com", "ball", "Centre of mass"],
];

/** While A is compared with it. */
const B: (typeof OWN)[number] = ["compare", "rival", "B: nominal pose, translucent"];

/** Layers that the profile has too. */
const SHARED: [Layer, string, string][] = [
  ["collision", "dots", "Collision points"],
  ["com", "com-line", "CoM path"],
  ["wheel", "wheel-line", "Wheel-centre path"],
  ["keys", "box", "Key poses"],
];

export function SceneLegend() {
  if (!legendOpen.value) return null;
  return (
    <fieldset class="scene-legend" aria-label="Shown in the scene">
      {[...OWN, ...(compare.value ? [B] : [])].map(([layer, mark, title]) => (
        <Row
          key={layer}
          mark={mark}
          title={title}
          on={sceneLayers.value.has(layer)}
          toggle={() => toggleSceneLayer(layer)}
        />
      ))}
      {SHARED.map(([layer, mark, title]) => (
        <Row
          key={layer}
          mark={mark}
          title={title}
          on={layers.value.has(layer)}
          toggle={() => toggleLayer(layer)}
        />
      ))}
    </fieldset>
  );
}

interface RowProps {
  mark: string;
  title: string;
  on: boolean;
  toggle: () => void;
}

function Row({ mark, title, on, toggle }: RowProps) {
  return (
    <button type="button" class={on ? "" : "off"} aria-pressed={on} onClick={toggle}>
      <i class={mark} aria-hidden="true" />
      {title}
    </button>
  );
}
