/** How the map is drawn, and where its cursor is. Nothing here changes an answer. */

import { computed, signal } from "@preact/signals";
import { axisShapes, legendShapes } from "./axes";
import { CODES } from "./codes";
import { type Field, UNKNOWN } from "./cube";
import { type Content, type Look, type Options, panelShapes } from "./draw";
import { type Frame, frameOf, type Place } from "./frame";
import type { Ink } from "./palette";
import { axisKind, quantityOf } from "./quantities";
import { difference, scaleOf, valuesOf } from "./scale";
import type { Picture } from "./shapes";
import { fields, layout, pairView, quantity, ready, robotAxis, study } from "./state";

export const options = signal<Options>({
  contours: true,
  reasons: true,
  numbers: false,
  codes: new Set(CODES.map((code) => code.name)),
});

export function toggle(name: "contours" | "reasons" | "numbers"): void {
  options.value = { ...options.peek(), [name]: !options.peek()[name] };
}

export function toggleCode(name: string): void {
  const codes = new Set(options.peek().codes);
  if (!codes.delete(name)) codes.add(name);
  options.value = { ...options.peek(), codes };
}

/** The cell under the pointer or the keys. */
export const cursor = signal<Place | null>(null);
/** The one that the right panel keeps. */
export const pinned = signal<Place | null>(null);
export const asTable = signal(false);

/** Building codes have a place on a map of tread and rise. */
export const showsCodes = computed(() => {
  const names = shownAxes.value?.map((axis) => axis.kind.name) ?? [];
  return names[0] === "stairs.tread" && names[1] === "stairs.rise";
});

/** The two axes that are drawn, with numbers. */
export const shownAxes = computed(() => {
  const [where, state] = [layout.value, study.value];
  if (!where || !state) return null;
  const of = (k: number | null) => {
    const axis = k === null ? null : state.axes[k]!;
    return axis
      ? { kind: axisKind(axis.name, axis.unit), values: axis.values as number[] }
      : { kind: { ...axisKind(""), title: "" }, values: [0] };
  };
  return [of(where.x), of(where.y)] as const;
});

/** One content a panel, all on one scale; a difference is one panel of its own. */
export const contents = computed<{ list: Content[]; most: number | null }>(() => {
  const [cube, list] = [ready(), fields.value];
  if (!cube || list.length === 0) return { list: [], most: null };
  const chosen = quantityOf(quantity.value);
  const values = list.map((field) => valuesOf(cube, field, chosen));
  const names = robotAxis.value?.values.map(String);
  if (names && pairView.value === "difference") {
    const { values: apart, most } = difference(values[0]!, values[1]!, chosen.rising);
    return {
      list: [{ field: common(list[0]!, list[1]!), values: apart, title: between(names) }],
      most,
    };
  }
  return {
    list: list.map((field, k) => ({
      field,
      values: values[k]!,
      ...(names ? { title: names[k]! } : {}),
    })),
    most: null,
  };
});

const between = (names: readonly string[]) => `${names[1]} minus ${names[0]}`;

/** Stopped where both are, for the second's reason; known where both are. */
function common(a: Field, b: Field): Field {
  const verdict = b.verdict.map((v, k) => {
    const w = a.verdict[k]!;
    return v === UNKNOWN || w === UNKNOWN ? UNKNOWN : Math.min(v, w);
  });
  return { ...b, verdict, coarse: b.coarse.map((c, k) => Math.max(c, a.coarse[k]!)) };
}

export const scale = computed(() =>
  scaleOf(
    contents.value.list.map((each) => each.values),
    quantityOf(quantity.value),
  ),
);

/** Some cells still stand for their neighbours. */
export const isCoarse = computed(() =>
  contents.value.list.some(({ field }) => field.coarse.some((c) => c > 1)),
);

export function frameFor(width: number, height: number): Frame | null {
  const axes = shownAxes.value;
  const { list } = contents.value;
  if (!axes || list.length === 0) return null;
  const { nx, ny } = list[0]!.field;
  return frameOf(width, height, nx, ny, list.length, Boolean(list[0]!.title));
}

export function pictureFor(frame: Frame, ink: Ink): Picture {
  const { list, most } = contents.value;
  const [x, y] = shownAxes.value!;
  const codes = showsCodes.value ? options.value.codes : new Set<string>();
  const look: Look = {
    ink,
    quantity: quantityOf(quantity.value),
    scale: scale.value,
    most,
    x,
    y,
    options: { ...options.value, codes },
  };
  const shapes = frame.panels.flatMap((panel, k) => panelShapes(panel, list[k]!, look));
  shapes.push(...axisShapes(frame, look), ...legendShapes(frame, look, isCoarse.value));
  return {
    width: frame.width,
    height: frame.height,
    shapes,
    font: ink.font,
    hatch: { line: ink.hatch, ground: ink.hatched },
  };
}
