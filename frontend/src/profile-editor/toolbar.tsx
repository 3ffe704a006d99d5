/** Tools, edits, snapping, presets, layers and zoom. */

import { useRef } from "preact/hooks";
import { PanelTools } from "../plan/panel-tools";
import { canRedo, canUndo, drawing, isEmpty, redo, selection, undo } from "../state/drawing";
import { LAYERS, type Layer, layers, type Tool, toggleLayer, tool } from "../state/view";
import { Icon } from "../ui/icon";
import { IconButton } from "../ui/icon-button";
import { Menu, MenuItem } from "../ui/menu";
import { useRoving } from "../ui/roving";
import { CODES } from "./codes";
import { deleteSelected, insertVertex } from "./commands";
import { code, GRIDS, grid, riserTolerance, TOLERANCES, toNeighbours } from "./snap";
import { fit, zoomPercent } from "./viewport";

const TOOLS: [Tool, string, string, string][] = [
  ["select", "Select", "V", "Drag corners and stretches; with Shift, all that follows moves along"],
  ["stair", "Stair", "S", "Drag up for one riser; with a stair code, along for a flight"],
  ["ramp", "Ramp", "R", "Drag from the foot to the top"],
  ["flat", "Flat", "F", "Drag along to level the ground"],
  ["free", "Free", "P", "Click corner by corner, or drag a line; Escape ends it"],
];

function gridName(step: number): string {
  if (step === 0) return "Off";
  return step < 0.01 ? `${step * 1000} mm` : `${step * 100} cm`;
}

export function Toolbar() {
  const bar = useRef<HTMLDivElement>(null);
  useRoving(bar);
  return (
    <div ref={bar} class="bar" role="toolbar" aria-label="Profile tools">
      <h2>Profile</h2>
      {TOOLS.map(([name, label, key, hint]) => (
        <button
          key={name}
          type="button"
          class={tool.value === name ? "t ico on" : "t ico"}
          aria-pressed={tool.value === name}
          aria-keyshortcuts={key}
          title={`${label} (${key}): ${hint}`}
          onClick={() => {
            tool.value = name;
          }}
        >
          <Icon name={name} />
          <span class="sr">{label}</span>
        </button>
      ))}
      <div class="sep" />
      <span class="wide-bar">
        <IconButton action={insertVertex} label="Add a corner" icon="plus" off={isEmpty.value} />
        <IconButton
          action={deleteSelected}
          label="Delete the corner"
          icon="trash"
          off={selection.value.length === 0}
        />
      </span>
      <IconButton action={undo} label="Undo" icon="undo" off={!canUndo.value} />
      <IconButton action={redo} label="Redo" icon="redo" off={!canRedo.value} />
      <div class="sep" />
      <SnapMenu />
      <div class="grow" />
      <LayerMenu />
      <IconButton
        action={() => fit(drawing.peek().points)}
        label="Fit to view"
        icon="fit"
        off={false}
      />
      <span class="zoom">{zoomPercent.value} %</span>
      <PanelTools panel="editor" title="profile" />
    </div>
  );
}

function SnapMenu() {
  const button = (
    <>
      <Icon name="snap" />
      <span class="sr">Snapping</span>
      <span class="lb">{code.value ? code.value.note : gridName(grid.value)}</span>
      <Icon name="down" />
    </>
  );
  return (
    <Menu label="Snapping" named button={button} buttonClass="t" panelClass="snaps">
      {(close) => (
        <>
          <div class="head">Grid (Alt suspends)</div>
          {GRIDS.map((step) => (
            <MenuItem
              key={step}
              checked={grid.value === step}
              onChoose={() => {
                grid.value = step;
                close();
              }}
            >
              {gridName(step)}
            </MenuItem>
          ))}
          <div class="head">Level and plumb</div>
          <MenuItem
            checked={toNeighbours.value}
            onChoose={() => {
              toNeighbours.value = !toNeighbours.value;
            }}
          >
            Other corners' x and z
          </MenuItem>
          <div class="head">Drawn risers become upright</div>
          {TOLERANCES.map((off) => (
            <MenuItem
              key={off}
              checked={riserTolerance.value === off}
              onChoose={() => {
                riserTolerance.value = off;
                close();
              }}
            >
              {off === 0 ? "Never" : `Within ${off * 100} cm`}
            </MenuItem>
          ))}
          <div class="head">Building codes</div>
          <MenuItem checked={code.value === null} onChoose={() => setCode(null, close)}>
            Free rise and run
          </MenuItem>
          {CODES.map((each) => (
            <MenuItem
              key={each.name}
              checked={code.value === each}
              onChoose={() => setCode(each, close)}
            >
              {each.name} <small>{each.note}</small>
            </MenuItem>
          ))}
        </>
      )}
    </Menu>
  );
}

function setCode(next: (typeof CODES)[number] | null, close: () => void): void {
  code.value = next;
  if (next) tool.value = "stair";
  close();
}

function LayerMenu() {
  const all = Object.keys(LAYERS) as Layer[];
  return (
    <Menu label="Layers" button={<Icon name="eye" />} buttonClass="t ico" align="right">
      {() =>
        all.map((layer) => (
          <button
            key={layer}
            type="button"
            class="item"
            role="menuitemcheckbox"
            tabIndex={-1}
            aria-checked={layers.value.has(layer)}
            onClick={() => toggleLayer(layer)}
          >
            {LAYERS[layer]}
          </button>
        ))
      }
    </Menu>
  );
}
