/** The ground itself, the wheel centre's path over it, and its dimensions. */

import { useRef } from "preact/hooks";
import type { Vec2 } from "../api/types";
import { fixed, slope } from "../geometry/format";
import { segmentKind } from "../geometry/profile";
import { wheelPath } from "../geometry/wheel-path";
import { drawing, isEmpty, selection } from "../state/drawing";
import { robot } from "../state/planning";
import { layers } from "../state/view";
import { useRoving } from "../ui/roving";
import { editingDimension } from "./dimension-field";
import { around, overlap, type Rect } from "./place";
import { canvasBox, projection, view } from "./viewport";

/** The drawn points and the ground's level ends beyond them. */
function shown(): Vec2[] {
  const points = drawing.value.points;
  const { left, right } = canvasBox.value;
  const { x, scale } = view.value;
  const [from, to] = [x - 1, x + (right - left) / scale + 1];
  if (points.length < 2) {
    return [
      [from, 0],
      [to, 0],
    ];
  }
  return points as Vec2[];
}

export function Ground() {
  const { at, px } = projection.value;
  const { bottom } = canvasBox.value;
  const points = shown();
  const first = points[0]!;
  const last = points[points.length - 1]!;
  const line = points.map(at).join(" ");
  return (
    <>
      <polygon
        fill="url(#ground)"
        points={`${line} ${px(last[0])},${bottom + 40} ${px(first[0])},${bottom + 40}`}
      />
      <polyline class="prof" points={line} />
    </>
  );
}

export function WheelPath() {
  const points = drawing.value.points;
  if (isEmpty.value || !robot.value || !layers.value.has("wheel")) return null;
  const { left, right } = canvasBox.value;
  const { x, scale } = view.value;
  const from = Math.max(points[0]![0], x - 0.1);
  const to = Math.min(points[points.length - 1]![0], x + (right - left) / scale + 0.1);
  const curve = wheelPath(points, robot.value.wheel, from, to, Math.max(0.002, 3 / scale));
  return <polyline class="wcp" points={curve.map(projection.value.at).join(" ")} />;
}

/** Faces lower than this have no room for their number [px]. */
const LEAST_RISE = 16;

/** Half a label's width and height, of a run or rise and of a slope [px]. */
const LABEL: Vec2 = [17, 7];
const SLOPE: Vec2 = [40, 9];

/** Tells whether a label still fits in between those that it was asked about before. */
function room(): (middle: Vec2, half: Vec2) => boolean {
  const taken: Rect[] = [];
  return (middle, half) => {
    const place = around(middle, ...half);
    if (taken.some((other) => overlap(place, other))) return false;
    taken.push(place);
    return true;
  };
}

/**
 * Runs along the lower rim, rises beside their faces, slopes on their stretch. A number without
 * room is left out.
 */
export function Dimensions() {
  const root = useRef<SVGGElement>(null);
  useRoving(root, "[data-dimension]");
  if (isEmpty.value || !layers.value.has("dimensions")) return null;
  const { points } = drawing.value;
  const { px, py } = projection.value;
  const { left, right, bottom } = canvasBox.value;
  const y = bottom - 26;
  const chosen = selection.value;
  const fits = room();
  const segments = points.slice(0, -1).map((a, i) => ({ i, a, b: points[i + 1]! }));
  return (
    <g ref={root}>
      {segments.map(({ i, a, b }) => {
        const kind = segmentKind(a, b);
        const edit = (which: "run" | "rise") => () => {
          editingDimension.value = { segment: i, which };
        };
        if (kind === "upright") {
          if (Math.abs(py(a[1]) - py(b[1])) < LEAST_RISE) return null;
          return (
            <Rise
              key={i}
              a={a}
              b={b}
              selected={chosen.includes(i + 1) || chosen.includes(i)}
              labelled={fits(riseLabel(a, b), LABEL)}
              edit={edit("rise")}
            />
          );
        }
        const [x0, x1] = [Math.max(left + 1, px(a[0])), Math.min(right, px(b[0]))];
        const end = i === 0 || i === segments.length - 1;
        const wide = x1 - x0;
        if (wide < 6) return null;
        const middle = (x0 + x1) / 2;
        return (
          <g key={i}>
            <path
              class="dim"
              d={`M${x0} ${y}H${x1}M${px(a[0])} ${y - 4}v8M${px(b[0])} ${y - 4}v8`}
            />
            {wide > 44 && fits([middle, y], LABEL) && (
              <Editable
                label={`${end && kind === "flat" ? "flat, run" : "Run"} ${fixed(b[0] - a[0], 3)} m`}
                edit={edit("run")}
              >
                <rect class="dimbg" x={middle - 20} y={y - 7} width={40} height={14} />
                <text class="dl" x={middle} y={y + 4} text-anchor="middle">
                  {end && kind === "flat" ? "flat" : fixed(b[0] - a[0], 3)}
                </text>
              </Editable>
            )}
            {kind === "slope" && wide > 90 && fits(slopeLabel(a, b), SLOPE) && (
              <SlopeLabel
                a={[px(a[0]), py(a[1])]}
                b={[px(b[0]), py(b[1])]}
                text={slope(b[0] - a[0], b[1] - a[1])}
              />
            )}
          </g>
        );
      })}
    </g>
  );
}

/** Below the middle of the stretch. */
function slopeLabel(a: Vec2, b: Vec2): Vec2 {
  const { px, py } = projection.value;
  return [px((a[0] + b[0]) / 2), py((a[1] + b[1]) / 2) + 14];
}

/** Inside the ground, beside the middle of the face. */
function riseLabel(a: Vec2, b: Vec2): Vec2 {
  const { px, py } = projection.value;
  return [px(a[0]) + (b[1] > a[1] ? 28 : -28), py((a[1] + b[1]) / 2)];
}

function SlopeLabel({ a, b, text }: { a: Vec2; b: Vec2; text: string }) {
  const [x, y] = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
  const angle = (Math.atan2(b[1] - a[1], b[0] - a[0]) * 180) / Math.PI;
  return (
    <text
      class="rl"
      x={x}
      y={y + 18}
      text-anchor="middle"
      transform={`rotate(${angle.toFixed(1)} ${x} ${y})`}
    >
      {text}
    </text>
  );
}

interface RiseProps {
  a: Vec2;
  b: Vec2;
  selected: boolean;
  labelled: boolean;
  edit: () => void;
}

function Rise({ a, b, selected, labelled, edit }: RiseProps) {
  const { px, py } = projection.value;
  const up = b[1] > a[1];
  const side = up ? 7 : -7;
  const x = px(a[0]) + side;
  const [y0, y1] = [py(a[1]), py(b[1])];
  const middle = (y0 + y1) / 2;
  const label = fixed(Math.abs(b[1] - a[1]), 3);
  return (
    <g class={selected ? "rise sel" : "rise"}>
      <path d={`M${x} ${y0 + (up ? -3 : 3)}V${y1 + (up ? 4 : -4)}`} />
      {labelled && (
        <Editable label={`Rise ${label} m`} edit={edit}>
          <text class="rl" x={x + (up ? 6 : -6)} y={middle + 4} text-anchor={up ? "start" : "end"}>
            {label}
          </text>
        </Editable>
      )}
    </g>
  );
}

interface EditableProps {
  label: string;
  edit: () => void;
  children: preact.ComponentChildren;
}

/** A dimension that opens as a field: double click, or Enter when focused. */
function Editable({ label, edit, children }: EditableProps) {
  const onKeyDown = (event: KeyboardEvent) => {
    if (event.key !== "Enter") return;
    event.preventDefault();
    edit();
  };
  return (
    <g
      class="editable"
      role="button"
      tabindex={0}
      aria-label={`${label}, Enter to change`}
      data-dimension
      onDblClick={edit}
      onKeyDown={onKeyDown}
    >
      {children}
    </g>
  );
}
