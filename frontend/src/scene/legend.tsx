/** What the scene's marks mean; each row shows or hides its own. L hides the legend. */

import {
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

export function SceneLegend() {
  if (!legendOpen.value) return null;
  return (
    <fieldset class="scene-legend" aria-label="Shown in the scene">
      {OWN.map(([layer, mark, title]) => (
        <Row
          key={layer}
          mark={mark}
          title={title}
          on={sceneLayers.value.has(layer)}
          toggle={() => toggleSceneLayer(layer)}
        />
      ))}
      <Row
        mark="dots"
        title="Collision points"
        on={layers.value.has("collision")}
        toggle={() => toggleLayer("collision")}
      />
      <Row
        mark="com-line"
        title="CoM path"
        on={layers.value.has("com")}
        toggle={() => toggleLayer("com")}
      />
      <Row
        mark="wheel-line"
        title="Wheel-centre path"
        on={layers.value.has("wheel")}
        toggle={() => toggleLayer("wheel")}
      />
      <Row
        mark="box"
        title="Key poses"
        on={layers.value.has("keys")}
        toggle={() => toggleLayer("keys")}
      />
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
