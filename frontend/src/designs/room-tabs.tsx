/** In the Map: cells of terrains, or fronts of designs. */

import { Segments } from "../inspector/segments";
import { showsDesigns } from "./state";

export function RoomTabs() {
  return (
    <>
      <h2 class="sr">Study</h2>
      <Segments
        small
        label="What is studied"
        options={[
          ["map", "Terrains"],
          ["designs", "Designs"],
        ]}
        value={showsDesigns.value ? "designs" : "map"}
        onChoose={(next) => {
          showsDesigns.value = next === "designs";
        }}
      />
    </>
  );
}
