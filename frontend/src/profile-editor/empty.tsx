/** An empty canvas offers four ways to begin. */

import type { TerrainDocument } from "../api/types";
import { extent } from "../geometry/profile";
import { isEmpty } from "../state/drawing";
import { terrains } from "../state/setup";
import { tool } from "../state/view";
import { openStored } from "../topbar/terrain-actions";

const CARDS: [RegExp, string, string][] = [
  [/^single-stair-036$/, "Single stair 0.36", "the paper's highest"],
  [/^ramp-30deg-025$/, "Ramp 0.25, 30°", "with and without poses"],
  [/^three-stairs-up$/, "3 stairs 0.125 / 0.30", "the paper's flight"],
  [/us.*7.*11|building/, "Building 7 / 11 in", "0.178 by 0.279, five steps"],
];

function sketch(terrain: TerrainDocument): string {
  const inner = terrain.points.slice(1, -1);
  const { x, z } = extent(inner.length > 0 ? inner : terrain.points);
  const wide = Math.max(0.3, x[1] - x[0]);
  const tall = Math.max(0.1, z[1] - z[0]);
  const scale = Math.min(84 / wide, 32 / tall);
  const left = (144 - wide * scale) / 2;
  return terrain.points
    .map((p) => {
      const px = Math.min(144, Math.max(0, left + (p[0] - x[0]) * scale));
      return `${px.toFixed(1)},${(40 - (p[1] - z[0]) * scale).toFixed(1)}`;
    })
    .join(" ");
}

export function EmptyCanvas() {
  if (!isEmpty.value || tool.value !== "select") return null;
  const found = CARDS.flatMap(([pattern, title, note]) => {
    const terrain = terrains.value.find((t) => t.readonly !== false && pattern.test(t.name));
    return terrain ? [{ terrain, title, note }] : [];
  });
  return (
    <div class="emptyc">
      <h2>Draw a profile or start from a preset</h2>
      <p>
        With Free (P), click corner by corner or drag a line. Or drop a CSV, JSON, YAML, STL or OBJ
        file.
      </p>
      <div class="pres">
        {found.map(({ terrain, title, note }) => (
          <button key={terrain.name} type="button" onClick={() => openStored(terrain)}>
            <svg viewBox="0 0 144 44" aria-hidden="true">
              <polyline points={sketch(terrain)} />
            </svg>
            <b>{title}</b>
            <small>{note}</small>
          </button>
        ))}
      </div>
    </div>
  );
}
