/** One cell in words, as the card, the right panel, the table and the live region tell it. */

import { fixed } from "../geometry/format";
import { PASSES, STOPPED } from "./cube";
import type { Place } from "./frame";
import { bindingWord, LEAST, QUANTITIES, quantityOf, reasonWords } from "./quantities";
import {
  asked,
  fields,
  layout,
  pairView,
  quantity,
  ready,
  robotAxis,
  slices,
  study,
} from "./state";
import { shownAxes } from "./view";

export interface CellFacts {
  /** Number in the study. */
  cell: number;
  title: string;
  verdict: "feasible" | "infeasible" | "pending";
  reason: string;
  message: string;
  /** It stands for a coarser cell next to it. */
  coarse: boolean;
  rows: readonly Row[];
  /** Of a difference: both robots' values, first. */
  both: readonly Row[];
}

interface Row {
  name: string;
  value: string;
  unit: string;
}

const withUnit = (value: number, digits: number, unit: string) =>
  `${fixed(value, digits)}${unit ? ` ${unit}` : ""}`;

export function titleOf({ i, j }: { i: number; j: number }): string {
  const axes = shownAxes.value;
  if (!axes) return "";
  const part = ({ kind, values }: (typeof axes)[0], k: number) =>
    kind.title
      ? `${kind.title.toLowerCase()} ${withUnit(values[k] ?? 0, kind.digits, kind.unit)}`
      : "";
  return [part(axes[1], j), part(axes[0], i)].filter(Boolean).join(", ");
}

/** Friction that the cell was asked with. */
export function frictionAt(): number | null {
  const state = study.value;
  const axis = state?.axes.find((each) => each.name === "friction");
  if (!axis) return asked.value?.friction ?? null;
  if (axis.boundary) return Math.max(...(axis.values as number[]));
  const others = layout.value?.others.map((k) => state!.axes[k]!) ?? [];
  return others.includes(axis) ? (axis.values[slices.value.friction ?? 0] as number) : null;
}

export function factsAt(place: Place): CellFacts | null {
  const names = robotAxis.value?.values.map(String);
  if (!names) return factsOf(place, 0);
  const own = names[place.panel] ?? "";
  if (pairView.value === "both") {
    const facts = factsOf(place, place.panel);
    return facts && { ...facts, both: [{ name: "Robot", value: own, unit: "" }] };
  }
  const each = [0, 1].map((robot) => factsOf(place, robot));
  const passing = each[1]?.verdict === "feasible" ? each[1] : each[0];
  return passing
    ? { ...passing, rows: [], both: each.map((facts, k) => told(names[k]!, facts)) }
    : null;
}

/** One robot of a difference: its value, or that it does not pass. */
function told(name: string, facts: CellFacts | null): Row {
  const kind = quantityOf(quantity.value);
  if (facts?.verdict === "infeasible") return { name, value: "not possible", unit: facts.reason };
  const row = facts?.rows.find((each) => each.name === kind.title);
  return { name, value: row?.value ?? "…", unit: row?.unit ?? "" };
}

function factsOf(place: Place, robot: number): CellFacts | null {
  const cube = ready();
  const field = fields.value[robot];
  if (!cube || !field) return null;
  const here = place.j * field.nx + place.i;
  const cell = field.cell[here]!;
  const verdict = field.verdict[here];
  const base = {
    cell,
    title: titleOf(place),
    coarse: field.coarse[here] !== 1,
    both: [],
  };
  if (verdict !== PASSES && verdict !== STOPPED) {
    return { ...base, verdict: "pending", reason: "", message: "", rows: [] };
  }
  if (verdict === STOPPED) {
    const reason = field.reason[here]!;
    return {
      ...base,
      verdict: "infeasible",
      reason: reasonWords(reason)[1],
      message: cube.word("message", cell),
      rows: [],
    };
  }
  const rows: Row[] = [];
  const friction = frictionAt();
  const border = field.border[here]!;
  for (const kind of QUANTITIES) {
    const searched = kind.name === LEAST && !Number.isNaN(border);
    const value = searched ? border : cube.number(kind.name, cell) * kind.scale;
    if (Number.isNaN(value)) continue;
    const of = kind.name === LEAST && friction !== null ? `of ${fixed(friction, 2)}` : kind.unit;
    rows.push({ name: kind.title, value: fixed(value, kind.digits), unit: of });
  }
  const binding = cube.word("binding", cell);
  if (binding) rows.push({ name: "What binds", value: bindingWord(binding), unit: "" });
  return { ...base, verdict: "feasible", reason: "", message: "", rows };
}

/** A cell in one breath: for the live region and as the table's cell. */
export function spoken(place: Place): string {
  const facts = factsAt(place);
  if (!facts) return "";
  if (facts.verdict === "pending") return `${facts.title}: not computed yet`;
  if (facts.both.length > 1) {
    const each = facts.both.map((row) => `${row.name} ${row.value} ${row.unit}`);
    return `${facts.title}: ${each.join(", ")}`;
  }
  if (facts.verdict === "infeasible") return `${facts.title}: not possible, ${facts.reason}`;
  const kind = quantityOf(quantity.value);
  const row = facts.rows.find((each) => each.name === kind.title);
  const binds = facts.rows.find((each) => each.name === "What binds");
  const told = row ? `, ${row.name.toLowerCase()} ${row.value} ${row.unit}` : "";
  return `${facts.title}: feasible${told}${binds ? `, ${binds.value} binds` : ""}`;
}
