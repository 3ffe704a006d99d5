/** Colours of the map, the same in both themes: mako turned round, light is easy, dark is hard. */

const STOPS = [
  "#e3f6ea",
  "#b5e5cb",
  "#7fd0b6",
  "#4db5ad",
  "#3a95a6",
  "#36759d",
  "#3a558f",
  "#3c3a6e",
  "#2c2347",
].map((hex) => [1, 3, 5].map((i) => Number.parseInt(hex.slice(i, i + 2), 16)));

/** For differences: orange where the first is better, blue where the second is. */
const SIDES = ["#8a4a00", "#c98a3c", "#ecd9bd", "#f2f2ef", "#c4d9ec", "#5b93c7", "#0d4a86"].map(
  (hex) => [1, 3, 5].map((i) => Number.parseInt(hex.slice(i, i + 2), 16)),
);

function between(stops: readonly (readonly number[])[], t: number): string {
  const at = Math.max(0, Math.min(1, t)) * (stops.length - 1);
  const i = Math.min(stops.length - 2, Math.floor(at));
  const mixed = stops[i]!.map((v, k) => Math.round(v + (stops[i + 1]![k]! - v) * (at - i)));
  return `rgb(${mixed.join()})`;
}

/** 0: easy, 1: hard. */
export const shade = (t: number): string => between(STOPS, t);

/** -1: the first is better, 1: the second is. */
export const side = (t: number): string => between(SIDES, (t + 1) / 2);

/** What is legible on a shade. */
export const inkOn = (t: number): string => (t < 0.42 ? "#121920" : "#ffffff");

/** Colours around the map; those of the page's theme, as a canvas and a file need them. */
export interface Ink {
  ground: string;
  panel: string;
  text: string;
  soft: string;
  faint: string;
  line: string;
  hatch: string;
  hatched: string;
  font: string;
}

export function inkOf(element: Element): Ink {
  const style = getComputedStyle(element);
  const read = (name: string) => style.getPropertyValue(name).trim();
  return {
    ground: read("--bg1"),
    panel: read("--bg1"),
    text: read("--tx"),
    soft: read("--tx2"),
    faint: read("--tx3"),
    line: read("--line2"),
    hatch: read("--hat"),
    hatched: read("--hatbg"),
    font: read("--f"),
  };
}
