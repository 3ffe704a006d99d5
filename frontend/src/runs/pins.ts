/** Pinned results are A, B, C, ...: told apart by colour and by dash. */

interface PinStyle {
  color: string;
  /** As in SVG. */
  dash: string;
}

const STYLES: readonly PinStyle[] = [
  { color: "var(--tx)", dash: "" },
  { color: "var(--third)", dash: "7 4" },
  { color: "var(--fourth)", dash: "1.5 3" },
  { color: "var(--tx2)", dash: "9 3 1.5 3" },
];

export const letter = (place: number) => String.fromCharCode(65 + (place % 26));
export const styleOf = (place: number): PinStyle => STYLES[place % STYLES.length]!;
