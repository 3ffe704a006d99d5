/** Colours of the plots, as the theme has them. */

import type { Color } from "./lines";

export type Palette = Record<Color | "line" | "bad" | "badSoft" | "acSoft" | "s0" | "bg", string>;

export function palette(): Palette {
  const css = getComputedStyle(document.documentElement);
  const of = (name: string) => css.getPropertyValue(name).trim();
  return {
    tx: of("--tx"),
    tx2: of("--tx2"),
    tx3: of("--tx3"),
    front: of("--front"),
    rear: of("--rear"),
    third: of("--third"),
    fourth: of("--fourth"),
    line: of("--line"),
    bad: of("--bad"),
    badSoft: of("--bad-soft"),
    acSoft: of("--ac-soft"),
    s0: of("--s0"),
    bg: of("--bg1"),
  };
}
