/** Which plots the dock shows. */

import { PANELS, type PanelId } from "../plots/lines";
import { shownPanels } from "../plots/room";
import { Icon } from "../ui/icon";
import { Menu } from "../ui/menu";

export function PlotMenu() {
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
