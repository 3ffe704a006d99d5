/** Pinned results are A, B, C, ...: told apart by colour and by dash. */

interface PinStyle {
  color: string;
  /** As in SVG. */
  dash: string;
}

const COLORS = ["var(--tx)", "var(--third)", "var(--fourth)", "var(--tx2)"] as const;
const DASHES = ["", "7 4", "1.5 3", "9 3 1.5 3"] as const;

export const letter = (place: number) => String.fromCharCode(65 + (place % 26));
/** Once all colours are there, each comes with another dash. */
export const styleOf = (place: number): PinStyle => ({
  color: COLORS[place % COLORS.length]!,
  dash: DASHES[(place + Math.floor(place / COLORS.length)) % DASHES.length]!,
});
