/** How aims and varied numbers of a design search read. */

import { capital, setting } from "../geometry/format";
import { AXES, axisKind, QUANTITIES } from "../map/quantities";
import { NUMBERS } from "./numbers";

interface Words {
  title: string;
  unit: string;
  show: (value: number) => string;
}

/** "robot.thigh.mass" is "Thigh mass". */
function plain(name: string): string {
  return capital(name.replace(/^robot\./, "").replaceAll(/[._]/g, " "));
}

export function wordsOf(name: string): Words {
  if (name === "mass") return { title: "Mass", unit: "kg", show: (v) => v.toFixed(2) };
  const number = NUMBERS.find((each) => each.name === name);
  if (number) {
    const { title, unit, digits } = number;
    return { title, unit, show: (v) => v.toFixed(digits) };
  }
  const known = AXES.some((each) => each.name === axisKind(name).name);
  if (known) {
    const { title, unit, digits } = axisKind(name);
    return { title, unit, show: (v) => v.toFixed(digits) };
  }
  const found = QUANTITIES.find((each) => each.name === name);
  if (!found) return { title: plain(name), unit: "", show: setting };
  const { title, unit, digits, scale } = found;
  return { title, unit: unit === "μ" ? "" : unit, show: (v) => (v * scale).toFixed(digits) };
}

export const withUnit = (name: string, value: number): string => {
  const { unit, show } = wordsOf(name);
  return `${show(value)} ${unit}`.trim();
};
