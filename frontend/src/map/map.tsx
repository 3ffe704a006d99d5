/** The workspace Map: how far can it go? Axes and progress, the map, codes and a kept cell. */

import { useEffect } from "preact/hooks";
import { followLinks } from "../designs/address";
import { showsDesigns } from "../designs/state";
import { fixed } from "../geometry/format";
import { designs } from "../parts";
import { Icon } from "../ui/icon";
import { IconButton } from "../ui/icon-button";
import { Show } from "../ui/part";
import { frictionAt } from "./cell";
import { CellPanel } from "./cell-panel";
import { Earlier } from "./earlier";
import { ExportMenu } from "./export";
import { MapView } from "./map-view";
import { Slices } from "./slices";
import { asked, begin, missing, pairView, refusal, remove, robotAxis, study } from "./state";
import { StudyPanel } from "./study-panel";
import { MapTable } from "./table";
import { asTable } from "./view";

export function MapRoom() {
  useEffect(followLinks, []);
  return showsDesigns.value ? <Show part={designs} /> : <Cells />;
}

function Cells() {
  useEffect(begin, []);
  return (
    <main class="map-room">
      <StudyPanel />
      <section class="map-middle" aria-label="Map">
        <header class="ph">
          <h2 title={subtitle() || undefined}>
            Capability map <small>{subtitle()}</small>
          </h2>
          {robotAxis.value && <PairView />}
          {study.value && (
            <button
              type="button"
              class={asTable.value ? "t on" : "t"}
              aria-pressed={asTable.value}
              onClick={() => {
                asTable.value = !asTable.value;
              }}
            >
              <Icon name="table" />
              Table
            </button>
          )}
          <Earlier />
          {study.value && <ExportMenu />}
          {study.value && (
            <IconButton icon="trash" label="Delete this map" action={remove} off={false} />
          )}
        </header>
        <Slices />
        {refusal.value && (
          <p class="error map-note" role="alert">
            {refusal.value}
          </p>
        )}
        <Body />
      </section>
      <CellPanel />
    </main>
  );
}

function subtitle(): string {
  const friction = frictionAt();
  const names = robotAxis.value?.values.join(" and ") ?? asked.value?.robot;
  if (!study.value || !names) return "";
  return friction === null ? names : `${names}, μ ${fixed(friction, 2)}`;
}

function Body() {
  if (missing.value) {
    return (
      <div class="map-empty">
        <h3>This service cannot compute maps.</h3>
        <p>{missing.value}</p>
      </div>
    );
  }
  if (!study.value) {
    return (
      <div class="map-empty">
        <h3>How far can it go?</h3>
        <p>
          Choose what varies and press Run. Each cell is one plan; a coarse picture comes first.
        </p>
      </div>
    );
  }
  return asTable.value ? <MapTable /> : <MapView />;
}

function PairView() {
  return (
    <div class="seg" role="radiogroup" aria-label="Two robots">
      {(["both", "difference"] as const).map((name) => (
        <button
          key={name}
          type="button"
          role="radio"
          aria-checked={pairView.value === name}
          class={pairView.value === name ? "on" : ""}
          onClick={() => {
            pairView.value = name;
          }}
        >
          {name === "both" ? "Side by side" : "Difference"}
        </button>
      ))}
    </div>
  );
}
