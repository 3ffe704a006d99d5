/** The profile that the plane cuts out of the mesh, or why it cuts none. */

import { fixed } from "../geometry/format";
import { cutProblem, profile, upToDate } from "./cut";

const WIDTH = 640;
const HEIGHT = 120;
const PAD = 10;

export function CutProfile() {
  const found = profile.value;
  if (cutProblem.value) {
    return (
      <div class="cut-profile">
        <p class="error" role="alert">
          {cutProblem.value}
        </p>
      </div>
    );
  }
  if (!found) return <div class="cut-profile" />;
  const x = found.points.map((p) => p[0]);
  const z = found.points.map((p) => p[1]);
  const [x0, x1] = [x[0]!, x.at(-1)!];
  const [z0, z1] = [Math.min(...z), Math.max(...z)];
  const scale = Math.min((WIDTH - 2 * PAD) / (x1 - x0), (HEIGHT - 2 * PAD) / (z1 - z0 || 1));
  const left = (WIDTH - scale * (x1 - x0)) / 2;
  const base = (HEIGHT + scale * (z1 - z0)) / 2;
  const line = found.points.map(
    ([a, b]) => `${left + scale * (a - x0)} ${base - scale * (b - z0)}`,
  );
  return (
    <figure class="cut-profile" aria-busy={!upToDate.value}>
      <svg viewBox={`0 0 ${WIDTH} ${HEIGHT}`} aria-hidden="true">
        <path
          class="ground"
          d={`M${left} ${HEIGHT}L${line.join("L")}L${left + scale * (x1 - x0)} ${HEIGHT}Z`}
        />
        <path class="edge" d={`M${line.join("L")}`} />
        {x0 <= 0 && x1 >= 0 && (
          <line class="zero" x1={left - scale * x0} x2={left - scale * x0} y1={0} y2={HEIGHT} />
        )}
      </svg>
      <figcaption>
        {found.points.length} corners, x {fixed(x0, 2)} to {fixed(x1, 2)} m, z {fixed(z0, 2)} to{" "}
        {fixed(z1, 2)} m
      </figcaption>
    </figure>
  );
}
