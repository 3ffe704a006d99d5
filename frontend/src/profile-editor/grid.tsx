/** Metric grid and rulers. */

import { fixed } from "../geometry/format";
import { drawing, selection } from "../state/drawing";
import { canvasBox, gridSteps, multiples, projection, RULER_X, RULER_Z, view } from "./viewport";

const crisp = (v: number) => Math.floor(v) + 0.5;

function lines() {
  const { px, py } = projection.value;
  const { left, top, right, bottom } = canvasBox.value;
  const { x, z, scale } = view.value;
  const { fine, coarse } = gridSteps(scale);
  const x1 = x + (right - left) / scale;
  const z1 = z + (bottom - top) / scale;
  const vertical = (step: number) => multiples(x, x1, step).map((v) => ({ v, at: crisp(px(v)) }));
  const horizontal = (step: number) => multiples(z, z1, step).map((v) => ({ v, at: crisp(py(v)) }));
  return {
    fine,
    coarse,
    xf: vertical(fine),
    xc: vertical(coarse),
    zf: horizontal(fine),
    zc: horizontal(coarse),
  };
}

export function Grid() {
  const { left, top, right, bottom } = canvasBox.value;
  const { xf, xc, zf, zc } = lines();
  const path = (xs: { at: number }[], zs: { at: number }[]) =>
    xs.map((l) => `M${l.at} ${top}V${bottom}`).join("") +
    zs.map((l) => `M${left} ${l.at}H${right}`).join("");
  return (
    <>
      <path class="grid" d={path(xf, zf)} />
      <path class="grid maj" d={path(xc, zc)} />
    </>
  );
}

/** Rulers cover the rim of the canvas; tags on them follow the selected corner. */
export function Rulers() {
  const { right, bottom } = canvasBox.value;
  const { coarse, xf, xc, zf, zc } = lines();
  const digits = coarse < 0.01 ? 3 : coarse < 1 ? 2 : 1;
  const every = (list: { v: number }[], mark: { v: number }) =>
    list.some((other) => Math.abs(other.v - mark.v) < 1e-9);
  const ticks =
    xf.map((l) => `M${l.at} ${RULER_X}v${every(xc, l) ? -8 : -4}`).join("") +
    zf.map((l) => `M${RULER_Z} ${l.at}h${every(zc, l) ? -8 : -4}`).join("");
  const { px, py } = projection.value;
  const i = selection.value[0];
  const chosen =
    selection.value.length === 1 && i !== undefined ? drawing.value.points[i] : undefined;
  const tagX = chosen && px(chosen[0]);
  const tagZ = chosen && py(chosen[1]);
  const inView = (v: number | undefined, from: number, to: number) =>
    v !== undefined && v >= from && v <= to;
  return (
    // biome-ignore lint/a11y/noAriaHiddenOnFocusable: a group in an SVG takes no focus
    <g aria-hidden="true">
      <rect class="rul" x={0} y={0} width={right} height={RULER_X} />
      <rect class="rul" x={0} y={0} width={RULER_Z} height={bottom} />
      {xc
        .filter((l) => tagX === undefined || Math.abs(l.at + 14 - tagX) > 34)
        .filter((l) => l.at > RULER_Z - 2)
        .map((l) => (
          <text key={l.v} class="rt" x={l.at + 3} y={11}>
            {fixed(l.v, digits)}
          </text>
        ))}
      {zc
        .filter((l) => (tagZ === undefined || Math.abs(l.at - tagZ) > 14) && l.at > RULER_X + 4)
        .filter((l) => l.at < bottom - 2)
        .map((l) => (
          <text key={l.v} class="rt" x={25} y={l.at + 3.5} text-anchor="end">
            {fixed(l.v, digits)}
          </text>
        ))}
      <path class="tick" d={ticks} />
      <path class="edge" d={`M${RULER_Z - 0.5} 0V${bottom}M0 ${RULER_X - 0.5}H${right}`} />
      <rect class="rul" x={0} y={0} width={RULER_Z - 1} height={RULER_X - 1} />
      <text class="rt" x={8} y={13}>
        m
      </text>
      {chosen && (
        <g class="rmark">
          {inView(tagX, RULER_Z, right) && (
            <>
              <rect x={tagX! - 20} y={2} width={40} height={16} rx={3} />
              <text x={tagX} y={13.5} text-anchor="middle">
                {fixed(chosen[0], 3)}
              </text>
            </>
          )}
          {inView(tagZ, RULER_X, bottom) && (
            <>
              <rect x={0} y={tagZ! - 8} width={35} height={16} rx={3} />
              <text x={17.5} y={tagZ! + 3.5} text-anchor="middle">
                {fixed(chosen[1], 3)}
              </text>
            </>
          )}
        </g>
      )}
    </g>
  );
}
